// Where and when the feet of a walk are, apart from the rest of the body.
#pragma once

#include <array>
#include <vector>

#include "core/types.hpp"

namespace weft::character {

/// A foot at rest, its sole flat on z = 0; lengths in metres.
struct FootShape {
  double ankle_height = 0;
  double ball_forward = 0, ball_height = 0;  ///< joint of the toes, from the place below the ankle
  double heel_back = 0, heel_radius = 0;     ///< the heel is round about a point behind the ankle
  double leg_length = 0;
};

/// A place where a foot stands for a while.
struct Plant {
  Vec2 at = Vec2::Zero();      ///< below the ankle while the sole is flat [m]
  double yaw = 0;              ///< of the foot, 0 toward -y, + to the left [rad]
  double strike = -1e9;        ///< when the heel touches [s]; the first one has always stood
  double off = 1e9;            ///< when the toes leave; the last one stands forever
  Vec2 detour = Vec2::Zero();  ///< of the step that brought it here, halfway: around the other foot [m]
  double step_size = 1;  ///< of the step that brought it here, against one of the recording; smaller ones lift less
};

struct FootState {
  Vec3 ankle = Vec3::Zero();
  double yaw = 0;    ///< [rad]
  double pitch = 0;  ///< [rad], + toes up; 0 flat
  double toes = 0;   ///< bend of the toes against the foot [rad], + up
  bool stands = true;
};

/// The way of one foot. While it stands it rolls without sliding: over the heel, which is round, stays flat, and
/// bends about the ball, the toes flat. In the air it follows a quintic that has place, velocity and acceleration of
/// rolling at both ends, lifted as recorded.
class FootPath {
 public:
  /// Plants in order; `period` of a stride [s].
  FootPath(const FootShape& shape, std::vector<Plant> plants, double period);

  FootState at(double t) const;

 private:
  double pitch(double t, std::size_t plant) const;
  Vec3 rolling_ankle(double t, std::size_t plant) const;
  Vec3 swinging_ankle(double t, std::size_t plant) const;

  FootShape shape_;
  std::vector<Plant> plants_;
  double period_;
};

/// Share of a stride for which a foot stands.
inline constexpr double kStance = 0.60;

/// Share of a stride from the first rise of a heel until the toes leave.
inline constexpr double kRise = 0.34;

/// Where and when both feet go.
struct StepPlan {
  std::array<std::vector<Plant>, 2> plants;  ///< of the left and the right foot
  double period = 0;                         ///< of a stride [s]
  double first_strike = 0;                   ///< of the left foot in even walking, modulo the period [s]
  double end = 0;                            ///< when the last foot has landed [s]
};

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

}  // namespace weft::character
