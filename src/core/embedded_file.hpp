// A file that was built into the program; embed_files.cmake writes the arrays of them.
#pragma once

#include <string_view>

namespace weft {

struct EmbeddedFile {
  std::string_view name;  ///< path below the folder that was built in, with slashes
  std::string_view text;
};

}  // namespace weft
