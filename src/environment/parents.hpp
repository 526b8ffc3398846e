// Rigid motion of obstacles and cameras that follow something: their parent.
#pragma once

#include <cstddef>
#include <memory>

#include "environment/key_frames.hpp"
#include "environment/track.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// What an obstacle or camera follows: another obstacle, or a part of a character.
struct Parent {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t obstacle = kNone;                 ///< number of the obstacle
  std::shared_ptr<const Track> part = nullptr;  ///< track of the part of a character, else null
  scene::Pose start = {};                       ///< of the parent at the start of the run

  bool is_any() const { return obstacle != kNone || part; }
};

/// Motion of an object relative to its parent: `own` is its motion if the parent stays at parent_start. Returns P(t)
/// P(start)⁻¹ own(t), with exact derivatives.
PoseSample compose(const PoseSample& parent, const scene::Pose& parent_start, const PoseSample& own);

/// Distance of the points of a frame on the skin from its origin [m]: so small that all are at one place of the skin.
inline constexpr double kFrameAxis = 1e-3;

/// Rigid motion closest to that of a frame (four points from vertex `first` on), with keys at the same times.
std::shared_ptr<const Track> track_of_frame(const KeyFrames& keys, std::size_t first,
                                            scene::Interpolation interpolation);

}  // namespace weft::environment
