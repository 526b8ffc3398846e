// Plays a clip in a scene: the body first stands still, then starts smoothly; the clip runs once or in a loop.
#pragma once

#include <optional>

#include "film/character/character.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Timing of a clip in the scene.
struct Timing {
  double motion_start = 0;  ///< scene time at which the clip begins to move [s]: end of scene::Character::dressing
  double blend = 0;         ///< time after `motion_start` in which the clip accelerates to `speed` [s]
  double start = 0;         ///< time of the clip at which it begins to play [s]
  double speed = 1;         ///< seconds of clip time per second of scene time
};

/// Time of the clip [s] at time t of the scene [s]; twice continuously differentiable if `blend` is positive.
double clip_time(const Timing& timing, double t);

struct Playing {
  Timing timing;
  bool loop = false;  ///< repeats the clip; each repetition (round) continues the horizontal travel of the one before
  double crossfade = 0;  ///< overlap in which a round blends into the next [s of clip time]; at most half of the clip
  std::optional<Pose> stance = {};  ///< pose until `motion_start`, then blended into the clip; absent: that at `start`
};

/// The poses of a body that plays a clip in a scene.
class Performance {
 public:
  /// The character and the clip must outlive this object. `up`: unit vector.
  Performance(const Character& character, const Clip& clip, const Playing& playing, const Vec3& up);

  /// The pose at time t [s] of the scene.
  Pose at(double t) const;

  /// Largest jump of a vertex from the end of a round to the start of the next [m]; 0 without a loop or with a
  /// crossfade.
  double gap() const;

 private:
  Pose at_clip_time(double t) const;
  /// Global transform of the parent of `root_` in a pose. Requires that `root_` exists.
  Affine parent_of_root(const Pose& pose) const;
  /// Translates a pose by the vector `by` in the world [m].
  void translate(Pose& pose, const Vec3& by) const;
  /// Horizontal displacement of the clip from pose a to pose b, in the world [m].
  Vec3 displacement_between(const Pose& a, const Pose& b) const;

  const Character& character_;
  const Clip& clip_;
  Playing playing_;
  Vec3 up_;
  Index root_ = -1;       // traveling_node() of the clip; -1: none
  double period_ = 0;     // clip time from the start of a round to the start of the next [s]
  Vec3 travel_{0, 0, 0};  // horizontal displacement of the body in a round [m]
  Vec3 shift_{0, 0, 0};   // horizontal displacement that moves the start of the clip to the position of `stance` [m]
};

/// Keys per second of the channel with the most keys; 0 for a clip that does not move.
double key_rate(const Clip& clip);

}  // namespace weft::character
