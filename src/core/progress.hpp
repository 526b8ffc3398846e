// How far a run is and how long it will take: a bar on terminals, plain lines elsewhere, never silence for long.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace weft {

/// The stages of the pipeline, in order.
enum class Stage : std::size_t { simulate, draw, write };
inline constexpr std::size_t kStages = 3;

/// Frames per stage.
using StageCounts = std::array<int, kStages>;

/// "48 s", "3:07 min", "1:02:45 h".
std::string format_duration(double seconds);

/// Estimates the time left from the pace of the last half minute, because cloth gets slower as layers touch.
class RemainingTime {
 public:
  explicit RemainingTime(StageCounts totals) : totals_(totals) {}

  /// Notes that `done` frames were finished `seconds` after the start; times must not decrease.
  void sample(double seconds, const StageCounts& done);

  /// Seconds left: the stages overlap, so the slowest decides. Nothing until two samples show a pace.
  std::optional<double> seconds() const;

 private:
  struct Sample {
    double seconds;
    StageCounts done;
  };
  StageCounts totals_;
  std::deque<Sample> samples_;
};

/// `[######------]  50 %  12 s left  sim 60  drawn 57  written 55 of 120`, cut to `columns`.
std::string progress_bar(const StageCounts& done, const StageCounts& totals, std::optional<double> seconds_left,
                         int columns);

/// `60 of 126 frames simulated, 57 of 126 drawn, 55 written after 12 s, about 15 s left`.
std::string progress_line(const StageCounts& done, const StageCounts& totals, double seconds,
                          std::optional<double> seconds_left);

/// Shows progress from a thread of its own until it is destroyed.
class Progress {
 public:
  enum class Style { automatic, bar, plain, none };

  /// `totals`: frames that each stage will handle. Automatic: a bar if standard error is a terminal, else lines.
  Progress(Style style, StageCounts totals);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more frame went through `stage`; one that has none to handle counts none. Safe from all threads.
  void advance(Stage stage) {
    const auto s = static_cast<std::size_t>(stage);
    if (totals_[s] > 0) done_[s].fetch_add(1, std::memory_order_relaxed);
  }

 private:
  StageCounts done() const;
  void run();

  const Style style_;
  const StageCounts totals_;
  std::array<std::atomic<int>, kStages> done_{};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace weft
