// Rigid motion of the parts of characters that obstacles and cameras follow.
#pragma once

#include <cstddef>
#include <memory>

#include "physics/motion/key_frames.hpp"
#include "physics/motion/track.hpp"

namespace weft::environment {

/// A frame represents a follower (an obstacle or a camera) of a part of a character. The frame has an origin, which is
/// the start position of the follower, and three points at the distance kFrameAxis from the origin, along the axes [m].
/// The distance is so small that all four points follow the same skin.
inline constexpr double kFrameAxis = 1e-3;

/// The rigid motion closest to the motion of a frame, whose origin is the vertex `first` and whose three points are the
/// next vertices. The track has keys at the times of `keys`.
std::shared_ptr<const motion::Track> track_of_frame(const motion::KeyFrames& keys, std::size_t first,
                                                    motion::Interpolation interpolation);

}  // namespace weft::environment
