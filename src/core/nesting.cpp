#include "core/nesting.hpp"

#include <algorithm>
#include <vector>

namespace weft {
namespace {

/// Position after the string whose opening quote is at `at`.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view triple_quote = quote == '"' ? "\"\"\"" : "'''";
  const bool long_string = text.substr(at, 3) == triple_quote;
  for (at += long_string ? 3 : 1; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (long_string && text.substr(at, 3) == triple_quote) {
      // The content may end with one or two quotes, directly before the closing three.
      at += 3;
      for (int k = 0; k < 2 && at < text.size() && text[at] == quote; ++k) ++at;
      return at;
    } else if (!long_string && (text[at] == quote || text[at] == '\n')) {
      return text[at] == quote ? at + 1 : at;
    }
  }
  return text.size();
}

}  // namespace

bool nests_too_deep(std::string_view text) {
  std::vector<int> open;  // for each open bracket, the levels that it adds: one, plus one per dot of the key before it
  int depth = 0;          // sum of `open`
  int dots = 0;           // number of dots in the current key and in its value
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_string(text, at);
      continue;
    }
    ++at;
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '.') {
      ++dots;
    } else if (c == '[' || c == '{') {
      open.push_back(dots + 1);
      depth += open.back();
      dots = 0;
    } else if (c == ']' || c == '}') {
      if (!open.empty()) {
        depth -= open.back();
        open.pop_back();
      }
      dots = 0;
    } else if (c == ',' || c == '\n') {
      dots = 0;
    }
    if (depth + dots > kMaxDepth) return true;
  }
  return false;
}

}  // namespace weft
