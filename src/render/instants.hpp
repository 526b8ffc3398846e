// Motion blur and depth of field: a picture as the mean of sharp ones, at times of the shutter and points of the lens.
#pragma once

#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// One of the sharp pictures.
struct Instant {
  double back = 0;  ///< time before the drawn frame [frames]
  Vec2 lens{0, 0};  ///< point on the lens [radii of the lens]
};

/// `count` instants, evenly spread over the lens and over a shutter of `shutter` degrees that closes at the frame.
/// Empty if neither is in use.
std::vector<Instant> instants(double shutter, bool lens, int count);

/// Interpolates linearly between a frame (back = 0) and the one before (back = 1) what both contain.
frame::FrameSnapshot between(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before, double back);
frame::Camera between(const frame::Camera& now, const frame::Camera& before, double back);

/// The camera with its eye moved to a point of its lens, and turned so that what is in focus keeps its place in the
/// picture.
frame::Camera through_lens(const frame::Camera& camera, const Vec3& up, const Vec2& lens);

}  // namespace weft::render
