// Wall and CPU time of a scope.
#pragma once

#include "core/timer.hpp"

namespace weft::simulation {

/// Adds the wall and CPU time of a scope to two counters.
class Stopwatch {
 public:
  Stopwatch(double& wall, double& cpu) : wall_(wall), cpu_(cpu) {}
  ~Stopwatch() {
    wall_ += timer_.seconds();
    cpu_ += thread_cpu_seconds() - cpu_start_;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double &wall_, &cpu_;
  WallTimer timer_;
  double cpu_start_ = thread_cpu_seconds();
};

}  // namespace weft::simulation
