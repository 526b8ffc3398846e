// Control characters, and names that become part of file names.
#pragma once

#include <cstddef>
#include <string_view>

namespace weft {

/// If a UTF-8 text begins with a control character, returns the number of bytes of this character:
/// 1 in ASCII, 2 for U+0080 to U+009F. Otherwise returns 0. Terminals and readers of logs could
/// interpret control characters.
inline std::size_t control_size(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : ' '); };
  if (byte(0) == 0xC2 && byte(1) >= 0x80 && byte(1) <= 0x9F) return 2;
  return byte(0) < 0x20 || byte(0) == 0x7F ? 1 : 0;
}

/// Whether a given name can be used in file names unchanged: it is not empty, not "." or "..", and
/// contains neither "/" nor control characters. Does not check whether the name is valid UTF-8.
inline bool is_plain_name(std::string_view name) {
  if (name.empty() || name == "." || name == "..") return false;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (name[i] == '/' || control_size(name.substr(i)) > 0) return false;
  return true;
}

}  // namespace weft
