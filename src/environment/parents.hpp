// Rigid motion that obstacles and cameras take over from what they follow: their parent.
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
  std::size_t obstacle = kNone;                 ///< by number
  std::shared_ptr<const Track> part = nullptr;  ///< else null
  scene::Pose start = {};                       ///< of the parent at the start of the run

  bool is_any() const { return obstacle != kNone || part; }
};

/// Motion of what has the motion `own` while its parent stands as at the start, and goes along with the parent:
/// P(t) P(start)⁻¹ own(t), with exact derivatives.
PoseSample compose(const PoseSample& parent, const scene::Pose& parent_start, const PoseSample& own);

/// Distance of the points of a frame on the skin from its origin [m]: so short that all lie at one place of the skin.
inline constexpr double kFrameAxis = 1e-3;

/// The rigid motion nearest to that of a frame, four points from vertex `first` on, with a key at each of the body's.
std::shared_ptr<const Track> track_of_frame(const KeyFrames& keys, std::size_t first,
                                            scene::Interpolation interpolation);

}  // namespace weft::environment
