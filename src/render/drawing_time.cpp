#include "render/drawing_time.hpp"

#include <mutex>
#include <vector>

#include "render/gl/context.hpp"

namespace weft::render {
namespace {

/// Of the pictures that are being drawn: where each one's sum is, and up to when all is shared out.
struct RasteriserShares {
  std::mutex mutex;
  std::vector<double*> sums;
  double until = 0;  // on the clocks of the rasteriser's threads

  void share_out() {
    const double now = rasteriser_cpu_seconds();
    for (double* sum : sums) *sum += (now - until) / static_cast<double>(sums.size());
    until = now;
  }
};

RasteriserShares& rasteriser_shares() {
  static RasteriserShares shares;
  return shares;
}

double own_cpu_seconds() {
  return thread_cpu_seconds() + helped_cpu_seconds;
}

}  // namespace

DrawingTimer::DrawingTimer() : began_(own_cpu_seconds()) {
  RasteriserShares& shares = rasteriser_shares();
  const std::lock_guard lock(shares.mutex);
  shares.share_out();
  shares.sums.push_back(&rasterised_);
}

DrawingTimer::~DrawingTimer() {
  RasteriserShares& shares = rasteriser_shares();
  const std::lock_guard lock(shares.mutex);
  std::erase(shares.sums, &rasterised_);
}

double DrawingTimer::cpu_seconds() const {
  RasteriserShares& shares = rasteriser_shares();
  const std::lock_guard lock(shares.mutex);
  shares.share_out();
  return own_cpu_seconds() - began_ + rasterised_;
}

}  // namespace weft::render
