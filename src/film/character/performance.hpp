// Plays a clip in a scene: the body first stands still, then starts smoothly; the clip runs once or in a loop.
#pragma once

#include <optional>
#include <vector>

#include "film/character/character.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Timing of a clip in the scene.
struct Timing {
  double motion_start = 0;  ///< scene time at which the clip begins [s]: end of scene::Character::dressing
  double blend = 0;         ///< time after `motion_start` in which the clip accelerates to `speed` [s]
  double start = 0;         ///< time of the clip at which it begins to play [s]
  double speed = 1;         ///< seconds of clip time per second of scene time
};

/// Time of the clip [s] at the time t of the scene [s]. The function is twice continuously differentiable if `blend` is
/// positive.
double clip_time(const Timing& timing, double t);

/// How a body plays a clip.
struct Playing {
  Timing timing;
  /// Whether the clip is repeated. Each repetition ("round") continues the horizontal travel of the round before.
  bool loop = false;
  /// Overlap in which a round blends into the next [s of clip time]. At most half of the clip's duration is used.
  double crossfade = 0;
  /// Pose until Timing::motion_start; it then blends into the clip within Timing::blend. Absent: the pose of the clip
  /// at Timing::start.
  std::optional<Pose> stance = {};
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
  /// Translates a pose by the vector `by` in the world [m].
  void translate(Pose& pose, const Vec3& by) const;
  /// Horizontal displacement of `leading_` from pose a to pose b, in the world [m]; zero without this node.
  Vec3 displacement_between(const Pose& a, const Pose& b) const;

  const Character& character_;
  const Clip& clip_;
  Playing playing_;
  Vec3 up_;
  std::vector<Index> roots_;  // traveling_nodes() of the clip
  Index leading_ = -1;        // leading_node() of them
  double period_ = 0;         // clip time from the start of a round to the start of the next [s]
  Vec3 travel_{0, 0, 0};      // horizontal displacement of the body in a round [m]
  Vec3 shift_{0, 0, 0};  // horizontal displacement from the start of the clip to the position of Playing::stance [m]
};

/// Rate of the keys of a clip [1/s]: the largest of any channel, (keys - 1) / duration in the mean or, if keys are
/// uneven, in 0.25 s where they are densest; 0 if the duration is 0.
double key_rate(const Clip& clip);

}  // namespace weft::character
