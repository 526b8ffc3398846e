// Location of this program: either installed in a system, or in an unpacked archive of `ninja bundle`, which contains
// its own dynamic loader and libraries.
#pragma once

#include <filesystem>

namespace weft {

struct Installation {
  std::filesystem::path program;    ///< executable that starts the program
  std::filesystem::path code;       ///< executable with the running code; in an archive, `program` only starts it
  std::filesystem::path libraries;  ///< folder of the archive's libraries; empty if those of the system are used
};

/// Location of this process. All paths are empty if /proc is not mounted.
Installation own_installation();

/// Sets the result of own_installation(). For tests that fork and run the program's code in the child process, where
/// /proc/self/exe is the test's executable. Not thread-safe.
void set_own_installation(const Installation& installation);

}  // namespace weft
