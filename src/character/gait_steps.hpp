// Where and when the feet of a walk stand. Times are counted in keys, of which a step has a whole even number.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "character/gait.hpp"
#include "character/mannequin.hpp"

namespace weft::character {

/// What a walk needs to know of a body; a foot at rest has its sole flat on z = 0; lengths in metres.
struct Physique {
  std::array<Vec3, kJointCount> joints;
  double height = 0;
  double foot_yaw = 0;  ///< of the left foot, outward [rad]
  double ankle_height = 0;
  double ball_forward = 0, ball_height = 0;  ///< joint of the toes, from the place below the ankle
  double heel_back = 0, heel_radius = 0;     ///< the heel is round about a point behind the ankle
  double toe_length = 0, toe_radius = 0;     ///< from the ball to the middle of the round tips
  double thigh = 0, shin = 0;
  double hips_half_width = 0;  ///< of the skin, where hands hang
  double stance_forward = 0;   ///< of the hips before the ankles, standing

  double leg() const { return thigh + shin; }
};
Physique physique_of(const Character& mannequin);

/// Lengths and times of even steps.
struct Pace {
  double step_length = 0;  ///< [m]
  double step_time = 0;    ///< half a stride [s]
};

/// For a speed [m/s] and a height of the body [m]. Step length over step rate (the walk ratio) is constant over
/// speeds from 1.03 m/s: 0.0062 m/(steps/min) in the recording; known for people as about 0.0065 (Sekiya & Nagasaki,
/// "Reproducibility of the walking patterns of normal young adults", 1998; bound: Murakami & Otaka, "Estimated lower
/// speed boundary at which the walk ratio constancy is broken", 2017). Length and time follow.
Pace pace_of(double speed, double height);

/// An even number.
int keys_of_step(const Pace& pace);

inline constexpr int kEver = 1 << 28;     ///< a key after all others
inline constexpr double kStance = 0.60;   ///< share of a stride for which a foot stands
inline constexpr double kSwing = 0.40;    ///< and for which it is in the air
inline constexpr double kOverlap = 0.10;  ///< and for which both stand after a strike

/// A place where a foot stands for a while.
struct Plant {
  Vec2 at = Vec2::Zero();  ///< below the ankle while the sole is flat [m]
  double yaw = 0;          ///< of the body that stands on it, 0 toward -y, + to the left [rad]
  double foot_yaw = 0;     ///< of the foot itself, whose toes point outward [rad]
  int strike = -kEver;     ///< when the heel touches; the first one has always stood
  int off = kEver;         ///< when the toes leave; the last one stands forever
  double aside = 0;        ///< way outward, halfway, of the step that brought it here: around the other foot [m]
  double size = 1;         ///< of that step, against an even one of the recording
};

/// Where and when both feet go.
struct StepPlan {
  std::array<std::vector<Plant>, 2> plants;  ///< of the left and the right foot
  struct Strike {
    int key, side;
  };
  std::vector<Strike> strikes;  ///< in their order
  double key_time = 0;          ///< [s]
  int step_keys = 0;
  double speed = 0;  ///< of even walking [m/s]

  int period() const { return 2 * step_keys; }
  /// The one where this foot stands, or stood last.
  std::size_t plant_at(int side, int key) const;
  /// Share of a stride since the heel has touched, and until the toes leave; large where that is never.
  double since_strike(const Plant& plant, double key) const { return (key - plant.strike) / period(); }
  double until_off(const Plant& plant, double key) const { return (plant.off - key) / period(); }
};

/// From standing to standing, with a turn halfway where the walk has one; `pace` as adjusted to the distance.
StepPlan plan_walk(const Physique& body, const Walk& walk);

}  // namespace weft::character
