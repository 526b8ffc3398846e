// Motion blur and depth of field: a picture as the mean of sharp ones, at moments of the shutter and places of the
// lens.
#pragma once

#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// One of the sharp pictures.
struct Instant {
  double back = 0;  ///< frames before the one that is drawn
  Vec2 lens{0, 0};  ///< place on the lens, in its radii
};

/// `count` of them, evenly spread over a shutter of `shutter` degrees that closes at the frame, and over the lens; none
/// where both stay out of use.
std::vector<Instant> instants(double shutter, bool lens, int count);

/// Between a frame (0) and the one before (1): what both have moves evenly in between.
frame::FrameSnapshot between(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before, double back);
frame::Camera between(const frame::Camera& now, const frame::Camera& before, double back);

/// The camera with its eye at a place of its lens, turned so that what is in focus stays where it is.
frame::Camera through_lens(const frame::Camera& camera, const Vec3& up, const Vec2& lens);

}  // namespace weft::render
