// A clip as a scene plays it: standing first, then getting going, once or again and again.
#pragma once

#include <optional>

#include "character/character.hpp"
#include "character/pose.hpp"

namespace weft::character {

/// When a clip is where.
struct Timing {
  double dressing = 0;  ///< [s] that pass before it moves
  double blend = 0;     ///< [s] in which it then gets from rest to its speed
  double start = 0;     ///< time of the clip that it gets going from [s]
  double speed = 1;
};

/// Time of the clip [s] at time t of the scene [s]; twice continuously differentiable if `blend` is positive.
double clip_time(const Timing& timing, double t);

struct Playing {
  Timing timing;
  bool loop = false;     ///< each round goes on from where the last one has come to, level
  double crossfade = 0;  ///< [s] of the clip at the end of a round that pass over into the next; at most half of it
  std::optional<Pose> stance = {};  ///< that it stands in, where the clip begins, instead of the clip's pose at `start`
};

class Performance {
 public:
  /// The character and the clip must outlive it. `up`: unit vector.
  Performance(const Character& character, const Clip& clip, const Playing& playing, const Vec3& up);

  /// The pose at time t [s] of the scene.
  Pose at(double t) const;

  /// How far the furthest vertex jumps from the end of a round to the beginning of the next [m].
  double gap() const;

 private:
  Pose at_clip_time(double t) const;
  /// Moves a pose of the clip by a displacement in the world [m].
  void displace(Pose& pose, const Vec3& by) const;
  /// From where the clip is at time a to where it is at b, level, in the world [m].
  Vec3 way(const Pose& a, const Pose& b) const;

  const Character& character_;
  const Clip& clip_;
  Playing playing_;
  Vec3 up_;
  Index root_ = -1;                        // the uppermost node that the clip moves along
  Mat3 root_to_world_ = Mat3::Identity();  // directions of its parent
  double period_ = 0;                      // of a round [s]
  Vec3 travel_{0, 0, 0}, shift_{0, 0, 0};  // of a round; of all poses of the clip [m]
};

/// Keys a second of the channel of a clip that has the most; 0 for a clip that does not move.
double key_rate(const Clip& clip);

}  // namespace weft::character
