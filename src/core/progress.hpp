// Progress and remaining time of a run: on terminals a bar, otherwise a line every few seconds.
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

/// A number of frames for each stage.
using StageCounts = std::array<int, kStages>;

/// Duration as text for users, such as "48 s", "3:07 min" or "1:02:45 h".
std::string format_duration(double seconds);

/// Estimates the remaining time from the frames of the last half minute: as layers of cloth come
/// into contact, frames take longer than at the beginning of a run.
class RemainingTime {
 public:
  explicit RemainingTime(StageCounts totals) : totals_(totals) {}

  /// Records that `done` frames were finished `seconds` after the start. Times must not decrease.
  void sample(double seconds, const StageCounts& done);

  /// Remaining time [s], that of the slowest stage, because stages work in parallel; 0 if all
  /// frames are done. Ignores a stage that has finished no frame in the last half minute, because
  /// its pace is not known. Returns nothing before the second sample, and if the pace of no stage
  /// with frames left is known.
  std::optional<double> seconds() const;

 private:
  struct Sample {
    double seconds;
    StageCounts done;
  };
  StageCounts totals_;
  std::deque<Sample> samples_;
};

/// A line such as `[#####-------]  47 %  12 s left  sim 60  drawn 57  written 55 of 120`, cut to at
/// most `columns` − 1 characters (`columns` = 0: not cut).
std::string progress_bar(const StageCounts& done, const StageCounts& totals, std::optional<double> seconds_left,
                         int columns);

/// A line such as `60 of 126 frames simulated, 57 of 126 drawn, 55 written after 12 s, about 15 s left`.
std::string progress_line(const StageCounts& done, const StageCounts& totals, double seconds,
                          std::optional<double> seconds_left);

/// Shows progress from its own thread until it is destroyed.
class Progress {
 public:
  enum class Style { automatic, bar, plain, none };

  /// `totals`: number of frames of each stage. Style::automatic shows a bar if standard error is a
  /// terminal and the variable TERM is set and not `dumb`; otherwise, it prints lines.
  Progress(Style style, StageCounts totals);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts one more frame of `stage`. Does nothing if the stage has no frames. Thread-safe.
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
  std::thread thread_;  // last member, because its thread uses all others
};

}  // namespace weft
