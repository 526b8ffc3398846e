// Rigid motion of the parts of characters that obstacles and cameras follow.
#pragma once

#include <cstddef>
#include <memory>

#include "physics/motion/key_frames.hpp"
#include "physics/motion/track.hpp"

namespace weft::environment {

/// Distance [m] from the origin of a frame, which is the start position of the follower, to each of its other three
/// points. It is so small that all four follow the same skin.
inline constexpr double kFrameAxis = 1e-3;

/// Rigid motion closest to that of a frame (an origin and three points along the axes, from vertex `first` on), with
/// keys at the times of `keys`.
std::shared_ptr<const motion::Track> track_of_frame(const motion::KeyFrames& keys, std::size_t first,
                                                    motion::Interpolation interpolation);

}  // namespace weft::environment
