// Orderly end on Ctrl-C and SIGTERM.
#pragma once

#include <atomic>
#include <string_view>

namespace weft::cli {

/// Lets SIGINT, SIGTERM and SIGHUP remove temporary files and end the process with code 75, unless the parent process
/// ignores them. Commands that do more have a StopSignals object.
void end_on_signals();

/// While an object lives, a first SIGINT, SIGTERM or SIGHUP only prints the promise and sets `requested()`. A
/// simulation step that still runs kStopGrace (core/stop.hpp) after the signal throws Error(interrupted). A second
/// signal removes temporary files and exits at once with code 75. Signals within a second count as one, since terminals
/// and tools such as timeout(1) signal both the process and its group. Signals that the parent process ignores (nohup,
/// background jobs) stay ignored. Only one object may exist at a time.
class StopSignals {
 public:
  /// `promise`: what is printed at the first signal; must be a string literal.
  explicit StopSignals(std::string_view promise = "finishing the current frame");
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True from the first signal on. Thread-safe.
  const std::atomic<bool>& requested() const;
};

}  // namespace weft::cli
