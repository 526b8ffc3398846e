// Timing and tables of the benchmark program.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/timer.hpp"

namespace weft::bench {

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Median CPU milliseconds of several runs of `work`.
template <class Work>
double median_ms(int runs, const Work& work) {
  std::vector<double> all;
  for (int run = 0; run < runs; ++run) {
    const double start = thread_cpu_seconds();
    work();
    all.push_back(1e3 * (thread_cpu_seconds() - start));
  }
  return median(all);
}

/// Adds the CPU milliseconds of `work` to `sum`.
template <class Work>
void add_ms(double& sum, const Work& work) {
  const double start = thread_cpu_seconds();
  work();
  sum += 1e3 * (thread_cpu_seconds() - start);
}

void replay(const std::filesystem::path& meshes, int first_frame, int frames, double reach);
void build_and_refit();
void wrapped_ball();
void distances();

}  // namespace weft::bench
