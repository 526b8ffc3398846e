#include "core/markup.hpp"

#include "core/json.hpp"

namespace weft {

std::string markup_text(const std::string& text) {
  const std::string valid = parse_json(json_text(text));  // replaces bytes that are not UTF-8
  std::string safe;
  for (const char c : valid) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '"')
      safe += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20)
      safe += ' ';
    else
      safe += c;
  }
  return safe;
}

}  // namespace weft
