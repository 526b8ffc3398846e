// Frame rates as exact fractions.
#pragma once

extern "C" {
#include <libavutil/rational.h>
}

namespace weft::video {

/// The rate that a decimal number denotes: 25 is 25/1, 12.5 is 25/2, and 23.976, 29.97, 47.952, 59.94 and 119.88 are
/// the broadcast rates n * 1000/1001. Throws Error(output_failed) outside 0.01 to 1000 frames per second.
AVRational frame_rate(double fps);

}  // namespace weft::video
