// Errors are exceptions that carry the exit code of the command line.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace weft {

/// Exit codes of the program, on which scripts rely.
enum class ExitCode : int {
  ok = 0,                 ///< success
  internal = 1,           ///< internal error
  usage = 2,              ///< command line not understood, or software is missing, such as Mesa
  scene_invalid = 3,      ///< the scene has mistakes, or surfaces touch at the start
  asset_unreadable = 4,   ///< an input file cannot be used, such as a mesh, motion or picture
  simulation_failed = 5,  ///< the simulation cannot continue; finished frames are kept
  output_failed = 6,      ///< disk, encoder or image writer failed
  images_differ = 7,      ///< pictures differ by more than the limits
  reference_missing = 8,  ///< a picture has no reference
  frames_missing = 9,     ///< requested frames are missing
  interrupted = 75,       ///< Ctrl-C or SIGTERM; finished frames are kept, and `--resume` continues
};

/// A failure with its exit code. The text says where, what was expected (with unit) and found, and what to do.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}

  template <class... Args>
  Error(ExitCode code, fmt::format_string<Args...> text, Args&&... args) requires(sizeof...(Args) > 0)
      : Error(code, fmt::format(text, std::forward<Args>(args)...)) {}

  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace weft
