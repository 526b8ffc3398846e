// Location of this program: in the system, or in an unpacked archive of `ninja bundle`, which
// contains a dynamic loader and libraries of its own.
#pragma once

#include <filesystem>

namespace weft {

struct Installation {
  std::filesystem::path program;    ///< executable that starts the program
  std::filesystem::path code;       ///< executable with the running code; differs from `program` in an archive alone
  std::filesystem::path libraries;  ///< folder of the archive's libraries; empty outside of an archive
};

/// Location of this process. All paths are empty if /proc is not mounted.
Installation own_installation();

/// Sets the result of own_installation(). For tests that run the program's code in a child process,
/// where /proc/self/exe is the executable of the test. Not thread-safe.
void set_own_installation(const Installation& installation);

}  // namespace weft
