// Plays a clip in a scene: the body stands at first, then speeds up; the clip runs once or in a loop.
#pragma once

#include <optional>

#include "film/character/character.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Timing of a clip in the scene.
struct Timing {
  double dressing = 0;  ///< scene time from which the clip moves; from the duration `dressing` of the scene [s]
  double blend = 0;     ///< time in which the clip then accelerates to `speed` [s]
  double start = 0;     ///< time of the clip at which it begins to play [s]
  double speed = 1;
};

/// Time of the clip [s] at time t of the scene [s]; twice continuously differentiable if `blend` is positive.
double clip_time(const Timing& timing, double t);

struct Playing {
  Timing timing;
  bool loop = false;     ///< repeats the clip; each repetition, a round, starts where the one before it has ended, but
                         ///< only horizontally
  double crossfade = 0;  ///< time at the end of a round in which it is blended into the next one [s of the clip];
                         ///< longer values are reduced to half of the clip
  std::optional<Pose> stance = {};  ///< initial pose of the body, in place of the clip's pose at `start`
};

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
  /// Transform of the root's parent in a pose; call it only if there is a root.
  Affine parent_of_root(const Pose& pose) const;
  /// Translates a pose of the clip in the world [m].
  void translate(Pose& pose, const Vec3& by) const;
  /// Horizontal displacement of the clip from pose a to pose b, in the world [m].
  Vec3 displacement_between(const Pose& a, const Pose& b) const;

  const Character& character_;
  const Clip& clip_;
  Playing playing_;
  Vec3 up_;
  Index root_ = -1;       // uppermost node that the clip translates; -1: none
  double period_ = 0;     // of a round [s]
  Vec3 travel_{0, 0, 0};  // per round [m]
  Vec3 shift_{0, 0, 0};   // moves the clip to where `stance` stands [m]
};

/// Keys per second of the channel with the most keys; 0 for a clip that does not move.
double key_rate(const Clip& clip);

}  // namespace weft::character
