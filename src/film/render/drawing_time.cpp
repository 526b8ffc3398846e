#include "film/render/drawing_time.hpp"

#include <mutex>
#include <vector>

#include "film/render/gl/context.hpp"

namespace weft::render {
namespace {

/// Distributes the rasteriser's CPU time evenly over the pictures that are being drawn. `sums`: the
/// rasteriser time of each of these pictures [s].
struct RasteriserTime {
  std::mutex mutex;
  std::vector<double*> sums;
  double distributed_until = 0;  // total CPU seconds of the rasteriser at the last distribution

  void distribute() {
    const double now = rasteriser_cpu_seconds();
    for (double* sum : sums) *sum += (now - distributed_until) / static_cast<double>(sums.size());
    distributed_until = now;
  }
};

RasteriserTime& rasteriser_time() {
  static RasteriserTime rasteriser;
  return rasteriser;
}

double own_cpu_seconds() {
  return thread_cpu_seconds() + helper_cpu_seconds;
}

}  // namespace

DrawingTimer::DrawingTimer() : start_seconds_(own_cpu_seconds()) {
  RasteriserTime& rasteriser = rasteriser_time();
  const std::lock_guard lock(rasteriser.mutex);
  rasteriser.distribute();
  rasteriser.sums.push_back(&rasteriser_seconds_);
}

DrawingTimer::~DrawingTimer() {
  RasteriserTime& rasteriser = rasteriser_time();
  const std::lock_guard lock(rasteriser.mutex);
  std::erase(rasteriser.sums, &rasteriser_seconds_);
}

double DrawingTimer::cpu_seconds() const {
  RasteriserTime& rasteriser = rasteriser_time();
  const std::lock_guard lock(rasteriser.mutex);
  rasteriser.distribute();
  return own_cpu_seconds() - start_seconds_ + rasteriser_seconds_;
}

}  // namespace weft::render
