// Motion blur and depth of field: a blurred picture is the mean of sharp ones, drawn at several times while the shutter
// is open and from several points of the lens.
#pragma once

#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::render {

/// Time and point on the lens for one of the sharp pictures.
struct Instant {
  double back = 0;  ///< time before the drawn frame [frames]
  Vec2 lens{0, 0};  ///< point on the lens [radii of the lens]
};

/// `count` instants, evenly spread over the time in which the shutter is open. This time ends at the drawn frame;
/// `shutter` is its length [degrees], where 360 degrees are the time between two frames. If `lens` is true, the
/// instants are also spread over the lens, and `count` must not be a multiple of 5; else, all are at its centre. If
/// `shutter` is 0 and `lens` is false, the result is empty.
std::vector<Instant> make_instants(double shutter, bool lens, int count);

/// Interpolates linearly between a frame (back = 0) and the frame before it (back = 1): time, positions, and direction,
/// position, target and intensity of lights. Surfaces and lights of both frames correspond by index. If `before` lacks
/// a surface, or if this surface has another name or number of vertices there, it stays as in `now`. Lights that
/// `before` lacks also stay as in `now`.
frame::FrameSnapshot interpolate_frames(const frame::FrameSnapshot& now, const frame::FrameSnapshot& before,
                                        double back);
/// Interpolates position, target and field of view of a camera in the same way. If there is a cut between both frames
/// (Camera::shot), the camera stays as in `now`.
frame::Camera interpolate_cameras(const frame::Camera& now, const frame::Camera& before, double back);

/// The camera with its eye moved to a point of its lens, and turned so that the point in focus on its view axis stays
/// in the middle of the picture. A camera without aperture stays unchanged.
frame::Camera through_lens(const frame::Camera& camera, const Vec3& up, const Vec2& lens);

}  // namespace weft::render
