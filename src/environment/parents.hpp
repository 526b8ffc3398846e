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

/// Motion of an object that follows `parent`, in the world: the product of poses parent · parent_start⁻¹ · own, with
/// exact derivatives. `own` is the motion that the object has if the parent stays at `parent_start`.
PoseSample compose(const PoseSample& parent, const scene::Pose& parent_start, const PoseSample& own);

/// Distance [m] from the origin of a frame, which lies on the skin, to each of its other three points. It is so small
/// that all four follow the same skin.
inline constexpr double kFrameAxis = 1e-3;

/// Rigid motion closest to that of a frame (an origin and three points along the axes, from vertex `first` on), with
/// keys at the times of `keys`.
std::shared_ptr<const Track> track_of_frame(const KeyFrames& keys, std::size_t first,
                                            scene::Interpolation interpolation);

}  // namespace weft::environment
