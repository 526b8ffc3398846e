// Wall and CPU stopwatches.
#pragma once

#include <chrono>
#include <ctime>

namespace weft {

/// Measures wall time since construction or the last restart.
class WallTimer {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void restart() { start_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// CPU seconds used so far by the calling thread.
inline double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds used so far by all threads of the process.
inline double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Wall time and CPU time that a stage of the work takes [s].
struct StageTime {
  double wall_s = 0, cpu_s = 0;

  StageTime& operator+=(const StageTime& other) {
    wall_s += other.wall_s;
    cpu_s += other.cpu_s;
    return *this;
  }
  StageTime& operator-=(const StageTime& other) {
    wall_s -= other.wall_s;
    cpu_s -= other.cpu_s;
    return *this;
  }
};

/// Selects the CPU time that a Stopwatch adds to its stage. False: the time of the calling thread
/// alone, because other threads draw and encode while this thread simulates. True: the time of all
/// threads, to include the helper threads of parallel loops; correct only if the process does
/// nothing else. Set it before any stage runs.
inline bool stopwatch_includes_all_threads = false;

/// Adds the wall and CPU time from its construction to its destruction to those of a stage.
class Stopwatch {
 public:
  explicit Stopwatch(StageTime& stage) : stage_(stage) {}
  ~Stopwatch() { stage_ += {timer_.seconds(), cpu_seconds() - cpu_start_}; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  static double cpu_seconds() { return stopwatch_includes_all_threads ? process_cpu_seconds() : thread_cpu_seconds(); }

  StageTime& stage_;
  WallTimer timer_;
  double cpu_start_ = cpu_seconds();
};

/// Calls `work` and returns the time that the call takes.
template <class Work>
StageTime timed(const Work& work) {
  StageTime stage;
  {
    const Stopwatch watch(stage);
    work();
  }
  return stage;
}

}  // namespace weft
