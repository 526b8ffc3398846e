// Location of this program: installed in a system, or in the unpacked archive of `ninja bundle`, which contains its own
// loader and libraries.
#pragma once

#include <filesystem>

namespace weft {

struct Installation {
  std::filesystem::path program;    ///< executable that starts the program
  std::filesystem::path code;       ///< file that contains the running code; in an archive another one than `program`
  std::filesystem::path libraries;  ///< folder of the archive's libraries; empty for those of the system
};

/// Location of this process. All paths are empty if /proc is not mounted.
Installation own_installation();

/// Overrides the result of own_installation(). For tests that fork and run the program's code in the child, where
/// /proc/self/exe is the test's executable. Not thread-safe.
void set_own_installation(const Installation& installation);

}  // namespace weft
