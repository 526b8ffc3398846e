// How failures travel: exceptions for what the user can mend, carrying the exit code of the command line.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace weft {

/// Exit codes of the program; part of its contract with scripts.
enum class ExitCode : int {
  ok = 0,                 ///< well
  internal = 1,           ///< our own fault
  usage = 2,              ///< command line not understood, or packages are missing
  scene_invalid = 3,      ///< the scene file has mistakes
  asset_unreadable = 4,   ///< a mesh, motion or picture file cannot be used
  simulation_failed = 5,  ///< the simulation cannot go on; finished frames are kept
  output_failed = 6,      ///< disk, encoder or image writer
  images_differ = 7,      ///< pictures differ by more than the limits
  reference_missing = 8,  ///< a picture has no reference
  not_whole = 9,          ///< frames that were asked for are not there
  interrupted = 75,       ///< Ctrl-C or SIGTERM; what is finished is kept, and `--resume` goes on
};

/// A failure with its exit code. The text says where, what was expected with its unit, what came, what to change.
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
