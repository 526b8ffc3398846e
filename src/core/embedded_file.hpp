// A file that is compiled into the program. embed_files.cmake generates arrays of EmbeddedFile.
#pragma once

#include <string_view>

namespace weft {

struct EmbeddedFile {
  std::string_view name;  ///< path below the embedded folder, with slashes
  std::string_view text;
};

}  // namespace weft
