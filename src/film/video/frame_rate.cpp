#include "film/video/frame_rate.hpp"

#include <cmath>

#include "core/error.hpp"

namespace weft::video {
namespace {

// Relative tolerance for broadcast rates n * 1000/1001. The decimal numbers that people write for them, such as 23.976,
// differ by at most 1.1e-6 from these rates. All other numbers with three decimals differ by at least 7e-6 (119.881).
constexpr double kBroadcastTolerance = 5e-6;

// Maximum numerator and denominator. The time unit of MP4, a power of two times the numerator, then fits into 32 bits.
constexpr int kMaxTerm = 100000;

}  // namespace

AVRational frame_rate(double fps) {
  if (!(fps >= 0.01 && fps <= 1000)) {
    throw Error(
        ExitCode::output_failed,
        "fps: expected 0.01 to 1000 frames a second in a video, got {}; change fps, or the STEP of --frames, which "
        "divides it, or write pictures",
        fps);
  }
  for (const int n : {24, 30, 48, 60, 120}) {
    const double broadcast = n * 1000.0 / 1001.0;
    if (std::abs(fps - broadcast) <= kBroadcastTolerance * broadcast) return {n * 1000, 1001};
  }
  return av_d2q(fps, kMaxTerm);
}

}  // namespace weft::video
