// What may become part of a file's name.
#pragma once

#include <string_view>

namespace weft {

/// Whether a name from outside can name files as it is: it leads into no other folder, and no terminal, list or log
/// reads it in another way. What is not ASCII is left to its writer.
inline bool is_plain_name(std::string_view name) {
  if (name.empty() || name == "." || name == "..") return false;
  for (const char c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F) return false;
  return true;
}

}  // namespace weft
