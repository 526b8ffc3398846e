// Checks names that become part of file names.
#pragma once

#include <string_view>

namespace weft {

/// Whether a name from outside can be used in file names as it is: it leads into no other folder, and contains no ASCII
/// control characters, which terminals, lists and logs could interpret. Bytes beyond ASCII are not checked.
inline bool is_plain_name(std::string_view name) {
  if (name.empty() || name == "." || name == "..") return false;
  for (const char c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F) return false;
  return true;
}

}  // namespace weft
