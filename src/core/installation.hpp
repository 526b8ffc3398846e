// Location of this program: installed in the system, or in an unpacked archive that `ninja bundle` has made. Such an
// archive contains its own dynamic loader and libraries.
#pragma once

#include <filesystem>

namespace weft {

struct Installation {
  std::filesystem::path program;    ///< executable that starts the program
  std::filesystem::path code;       ///< executable with the running code; differs from `program` only in an archive
  std::filesystem::path libraries;  ///< folder of the archive's libraries; empty outside of an archive
};

/// Location of this program. All paths are empty if /proc is not mounted.
Installation own_installation();

/// Sets the result of own_installation(). Tests that run the program's code in a child process need
/// this, because there /proc/self/exe is the executable of the test. Not thread-safe.
void set_own_installation(const Installation& installation);

}  // namespace weft
