// Ctrl-C and SIGTERM.
#pragma once

#include <atomic>
#include <string_view>

namespace weft::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP only ask for an orderly end, which `requested()` tells; a simulation step
/// that takes longer than kStopGrace from then on throws Error(interrupted). A second signal
/// removes temporary files and quits at once with exit code 75; repeats within a second count as one, since tools such
/// as timeout(1) and terminals send a signal to the process and again to its group. Signals that the parent chose to
/// ignore (nohup, background jobs) stay ignored. One object at a time.
class StopSignals {
 public:
  /// `promise`: what is said to whoever asks; a literal.
  explicit StopSignals(std::string_view promise = "finishing the current frame");
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True from the first signal on. Safe from all threads.
  const std::atomic<bool>& requested() const;
};

}  // namespace weft::cli
