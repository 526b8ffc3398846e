#include "core/nesting.hpp"

#include <algorithm>
#include <vector>

namespace weft {
namespace {

/// The first character behind the string that begins at `at` with a quote.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool long_string = text.substr(at, 3) == three;
  for (at += long_string ? 3 : 1; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (long_string && text.substr(at, 3) == three) {
      // The string may end in one or two quotes of its own.
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
  std::vector<int> open;  // levels of each open bracket: the bracket, and the parts of the key before it
  int outside = 0;        // their sum
  int dots = 0;           // of the key that is read; those of a number after it count as well
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
      outside += open.back();
      dots = 0;
    } else if (c == ']' || c == '}') {
      if (!open.empty()) {
        outside -= open.back();
        open.pop_back();
      }
      dots = 0;
    } else if (c == ',' || c == '\n') {
      dots = 0;
    }
    if (outside + dots > kMaxDepth) return true;
  }
  return false;
}

}  // namespace weft
