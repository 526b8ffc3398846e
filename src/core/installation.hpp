// Where this program lies: in a system, or in the unpacked archive of `ninja bundle`, which brings its own loader and
// libraries.
#pragma once

#include <filesystem>

namespace weft {

struct Installation {
  std::filesystem::path program;    ///< to start in order to run it again
  std::filesystem::path code;       ///< the file with the running code; in an archive not the one that was started
  std::filesystem::path libraries;  ///< folder of the libraries that came along; empty if they are those of the system
};

/// Of this process. All empty where /proc is not mounted.
Installation own_installation();

/// From now on own_installation() returns this. For tests, whose forks stand for the program; not for several threads.
void set_own_installation(const Installation& installation);

}  // namespace weft
