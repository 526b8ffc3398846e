// Positions and times of the footholds of a walk. The unit of times is the interval between key frames ("key"). A step
// is half a stride and has an even number of keys.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "film/character/gait.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {

/// Measures of a body on which a walk depends [m]. In the rest pose, soles are flat on z = 0.
struct Physique {
  std::array<Vec3, kJointCount> joints;  ///< positions in the rest pose
  double height = 0;
  double foot_yaw = 0;  ///< outward rotation of the left foot [rad]
  double ankle_height = 0;
  double ball_forward = 0, ball_height = 0;  ///< position of the toe joint, relative to the floor point below the ankle
  double heel_back = 0, heel_radius = 0;     ///< radius of the round heel; its centre is `heel_back` behind the ankle
  double toe_length = 0, toe_radius = 0;     ///< distance from ball to centre of the round toe tips; their radius
  double thigh = 0, shin = 0;
  double hips_half_width = 0;  ///< half width of the trunk at the height of the hanging hands
  double stance_forward = 0;   ///< distance of the hips in front of the ankles of a standing body

  double leg() const { return thigh + shin; }
};
/// Measures a mannequin in its rest pose.
Physique physique_of(const Character& mannequin);

/// Length and duration of a step in steady walking.
struct Pace {
  double step_length = 0;  ///< [m]
  double step_time = 0;    ///< half a stride [s]
};

/// Pace for a speed [m/s] and a body height [m]. The walk ratio (step length / step rate) is the same at all speeds:
/// that of the recorded walk (gait_curves.hpp), 0.0062 m/(steps/min) at a height of 1.70 m, scaled by the height. In
/// people, the walk ratio is about 0.0065 m/(steps/min) (Sekiya & Nagasaki, "Reproducibility of the walking patterns of
/// normal young adults", 1998) and constant for speeds from 1.03 m/s on (Murakami & Otaka, "Estimated lower speed
/// boundary at which the walk ratio constancy is broken", 2017).
Pace pace_of(double speed, double height);

/// Number of keys in a step; always even.
int keys_of_step(const Pace& pace);

inline constexpr int kFarKey = 1 << 28;   ///< a key number after all keys of any walk
inline constexpr double kStance = 0.60;   ///< stance phase [strides]
inline constexpr double kSwing = 0.40;    ///< swing phase [strides]
inline constexpr double kOverlap = 0.10;  ///< double support after a strike [strides]

/// A foothold: a position where a foot stands for some time.
struct Foothold {
  Vec2 at = Vec2::Zero();  ///< point on the floor below the ankle while the sole is flat [m]
  double yaw = 0;          ///< heading of the body at this foothold, 0 toward -y, + to the left [rad]
  double foot_yaw = 0;     ///< heading of the foot: `yaw` plus the outward rotation of the toes [rad]
  int strike = -kFarKey;   ///< key of the heel strike; before all keys for the first foothold
  int off = kFarKey;       ///< key of toe-off; after all keys for the last foothold
  double aside = 0;        ///< outward detour around the other foot, in the middle of the step to this foothold [m]
  double size = 1;         ///< size of the step to this foothold, relative to a step of the recorded walk
};

/// Footholds of both feet, and timing of the steps.
struct StepPlan {
  std::array<std::vector<Foothold>, 2> footholds;  ///< footholds of the left and the right foot
  struct Strike {
    int key, side;
  };
  std::vector<Strike> strikes;  ///< in chronological order
  double key_time = 0;          ///< duration of a keyframe interval [s]
  int step_keys = 0;            ///< keys in a step
  double speed = 0;             ///< steady walking speed [m/s]

  /// Number of keys in a stride.
  int period() const { return 2 * step_keys; }
  /// Number of the foothold where the foot `side` stands at the key `key`; in swing, where it stood last.
  std::size_t foothold_at(int side, int key) const;
  /// Strides since the heel strike, and strides until toe-off; large if the foothold has no strike or no toe-off.
  double strides_since_strike(const Foothold& foothold, double key) const { return (key - foothold.strike) / period(); }
  double until_off(const Foothold& foothold, double key) const { return (foothold.off - key) / period(); }
};

/// Plans a walk that begins and ends with standing and, if `walk.turn_back`, turns around at its far end. Adjusts the
/// pace such that a whole number of steps covers the distance.
StepPlan plan_walk(const Physique& body, const Walk& walk);

}  // namespace weft::character
