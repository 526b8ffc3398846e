// Handles SIGINT (Ctrl-C), SIGTERM and SIGHUP, so that the process leaves no temporary files.
#pragma once

#include <atomic>
#include <string_view>

namespace weft::cli {

/// Installs a handler for SIGINT, SIGTERM and SIGHUP that removes temporary files and ends the process with exit code
/// 75. Signals that the parent process ignores stay ignored. Commands that must finish work first use StopSignals.
void end_on_signals();

/// While the object exists, the first SIGINT, SIGTERM or SIGHUP only prints `promise` and sets requested(). A
/// simulation step that still runs kStopGrace (core/stop.hpp) after the signal throws Error(interrupted). A second
/// signal removes temporary files and ends the process with exit code 75. Signals within one second count as one, since
/// terminals and tools such as timeout(1) signal both the process and its group. Signals that the parent process
/// ignores (nohup, background jobs) stay ignored. Only one object may exist at a time.
class StopSignals {
 public:
  /// `promise`: text for the user on what the command still does; must be a string literal.
  explicit StopSignals(std::string_view promise = "finishing the current frame");
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True from the first signal on. Thread-safe.
  const std::atomic<bool>& requested() const;
};

}  // namespace weft::cli
