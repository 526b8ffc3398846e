#include "film/character/gait_steps.hpp"

#include <algorithm>
#include <cmath>

#include "film/character/gait_curves.hpp"

namespace weft::character {
namespace {

constexpr double kKeysPerSecond = 60;
constexpr double kHalfTrack = 0.048;     ///< ankle to midline / body height; thighs touch at the recorded 0.038
constexpr double kOutwardDetour = 0.07;  ///< outward detour of a foot that turns with the body [m]
constexpr double kFirstStepRatio = 0.65,
                 kLastStepRatio = 0.75;        ///< lengths of the first and the last step, relative to a steady step
constexpr double kWeightShiftFraction = 0.45;  ///< time in which the weight shifts before the first step [strides]

/// Rotation of the body at each step of a turn by 180° [degrees], toward the foot that steps first (the inner foot).
/// The rotation at the steps of the inner foot (entries 0 and 2) is larger, so that toes do not collide.
constexpr std::array<double, 4> kTurnAngles{54, 36, 54, 36};
constexpr double kTurnStep = 0.11;  ///< forward distance per step of a turn [m], for a height of 1.75 m

Vec2 forward_of(double yaw) {
  return {std::sin(yaw), -std::cos(yaw)};
}
Vec2 left_of(double yaw) {
  return {std::cos(yaw), std::sin(yaw)};
}

/// Size of steady steps: step length / leg length, relative to that of the recorded walk; clamped to 0.5 to 1.2.
double step_size(const Physique& body, const Pace& pace) {
  const double recorded = walking::kSpeed * walking::kPeriod / 2 * body.leg() / walking::kLegLength;
  return std::clamp(pace.step_length / recorded, 0.5, 1.2);
}

/// One step: motion of the body relative to its position at the preceding step. The foot is placed beside the body.
struct Step {
  double forward = 0, left = 0;  ///< [m]
  double turn = 0;               ///< [rad]
  double size = 1;               ///< see Foothold::size
};

/// Collects the steps of a walk.
class Planner {
 public:
  Planner(const Physique& body, const Pace& pace, double stand) : body_(body) {
    plan.step_keys = keys_of_step(pace);
    plan.key_time = pace.step_time / plan.step_keys;
    plan.speed = pace.step_length / pace.step_time;
    next_strike_ = static_cast<int>(std::round(stand / plan.key_time)) + keys_of_fraction(kWeightShiftFraction) +
                   keys_of_fraction(kSwing);
    for (int side = 0; side < 2; ++side) plan.footholds[side].push_back(make_foothold(side));
  }

  /// Moves the middle of the body and places one foot beside it.
  void step(int side, const Step& step) {
    yaw_ += step.turn;
    middle_ += step.forward * forward_of(yaw_) + step.left * left_of(yaw_);
    auto& footholds = plan.footholds[side];
    Foothold foothold = make_foothold(side);
    foothold.strike = next_strike_;
    foothold.size = step.size;
    if (step.turn != 0) foothold.aside = kOutwardDetour;
    footholds.back().off = next_strike_ - keys_of_fraction(kSwing);
    footholds.push_back(foothold);
    plan.strikes.push_back({next_strike_, side});
    next_strike_ += plan.step_keys;
  }

  StepPlan plan;

 private:
  int keys_of_fraction(double of_stride) const { return static_cast<int>(std::round(of_stride * plan.period())); }

  Foothold make_foothold(int side) const {
    const double sign = side == 0 ? 1 : -1;
    Foothold foothold;
    foothold.at = middle_ + sign * kHalfTrack * body_.height * left_of(yaw_) - body_.stance_forward * forward_of(yaw_);
    foothold.yaw = yaw_;
    foothold.foot_yaw = yaw_ + sign * body_.foot_yaw;
    return foothold;
  }

  const Physique& body_;
  Vec2 middle_ = Vec2::Zero();
  double yaw_ = 0;
  int next_strike_ = 0;
};

/// Adds the steps of a straight path, beginning with the foot `side`. `left`: total offset to the left [m], divided
/// among at most four steps from step `from` on. Returns the side of the next foot.
int add_straight_steps(Planner& planner, const Physique& body, const Pace& pace, int steps, int side, double left,
                       int from) {
  const int aside = std::min(4, steps);
  for (int k = 0; k < steps; ++k, side = 1 - side) {
    Step step;
    step.size = step_size(body, pace);
    step.forward = pace.step_length * (k == 0 ? kFirstStepRatio : k + 1 == steps ? kLastStepRatio : 1);
    if (k == 0) step.size *= 0.8;
    if (k >= from && k < from + aside) step.left = left / aside;
    planner.step(side, step);
  }
  return side;
}

/// Adds a turn by 180° on a small arc, beginning with the foot `side`. Returns the side of the next foot.
int add_turn_steps(Planner& planner, const Physique& body, int side) {
  const double sign = side == 0 ? 1 : -1, forward = kTurnStep * body.height / 1.75;
  for (const double turn : kTurnAngles) {
    planner.step(side, {forward, 0, sign * turn * kDegree, 0.5});
    side = 1 - side;
  }
  return side;
}

/// Displacement of the body by a turn to the left: ahead and to the left, in the axes before the turn [m].
Vec2 turn_displacement(const Physique& body) {
  double yaw = 0;
  Vec2 displacement = Vec2::Zero();
  for (const double turn : kTurnAngles) {
    yaw += turn * kDegree;
    displacement += kTurnStep * body.height / 1.75 * Vec2(std::cos(yaw), std::sin(yaw));
  }
  return displacement;
}

}  // namespace

Physique physique_of(const Character& mannequin) {
  Physique body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Node& node = mannequin.nodes[j];
    body.joints[j] = node.local.translation();
    if (node.parent >= 0) body.joints[j] += body.joints[node.parent];
  }
  const auto at = [&](Joint joint) -> const Vec3& { return body.joints[joint_index(joint)]; };
  const Vec3 hip = at(Joint::left_upper_leg), knee = at(Joint::left_lower_leg), ankle = at(Joint::left_foot),
             ball = at(Joint::left_toes) - ankle;
  body.height = hip.z() / 0.530;
  body.foot_yaw = std::atan2(ball.x(), -ball.y());
  const double cm = body.height / 175;
  body.ankle_height = ankle.z();
  body.ball_forward = std::hypot(ball.x(), ball.y());
  body.ball_height = ankle.z() + ball.z();
  body.heel_back = 3.35 * cm;
  body.heel_radius = 2.4 * cm;
  body.toe_length = 6.0 * cm;
  body.toe_radius = 1.0 * cm;
  body.thigh = (knee - hip).norm();
  body.shin = (ankle - knee).norm();
  body.stance_forward = 1.3 * cm;
  // These limits select the trunk. Hands in the rest pose are farther out.
  for (const Vec3& p : mannequin.mesh.positions)
    if (p.z() > 75 * cm && p.z() < 98 * cm && p.x() < 35 * cm)
      body.hips_half_width = std::max(body.hips_half_width, p.x());
  return body;
}

Pace pace_of(double speed, double height) {
  constexpr double walk_ratio = 0.0062;     // m/(steps/min), from the recording
  constexpr double recorded_height = 1.70;  // m, estimated from the leg length in the recording
  const double length = std::sqrt(walk_ratio * height / recorded_height * 60 * speed);
  return {length, length / speed};
}

int keys_of_step(const Pace& pace) {
  return 2 * static_cast<int>(std::round(kKeysPerSecond / 2 * pace.step_time));
}

std::size_t StepPlan::foothold_at(int side, int key) const {
  const auto& list = footholds[side];
  std::size_t foothold = 0;
  while (foothold + 1 < list.size() && key >= list[foothold + 1].strike) ++foothold;
  return foothold;
}

StepPlan plan_walk(const Physique& body, const Walk& walk) {
  Pace pace = pace_of(walk.speed, body.height);
  // A whole number of steps covers the distance; the first and the last are shorter.
  constexpr double shorter = 2 - kFirstStepRatio - kLastStepRatio;
  const int fitting = static_cast<int>(std::round(walk.distance / pace.step_length + shorter));
  const int steps = std::max(2, fitting);
  pace.step_length = walk.distance / (steps - shorter);
  // If the distance is too short for two such steps, the two steps are shorter and keep their duration.
  if (fitting >= 2) pace.step_time = pace.step_length / walk.speed;
  Planner planner(body, pace, walk.stand);
  int side = 1;
  if (walk.turn_back) {
    // The turn displaces the body sideways. The steps before it compensate half of this, the steps after it the rest.
    const Vec2 arc = turn_displacement(body);
    // The first step of the turn covers the last part of the distance.
    const double ahead = std::cos(kTurnAngles[0] * kDegree) * kTurnStep * body.height / 1.75;
    // If the walk is shorter than the turn, the steps have length 0, so that the body does not step backward.
    pace.step_length = std::max(0.0, pace.step_length - ahead / (steps - shorter));
    const double aside = (1 + steps) % 2 == 0 ? -0.5 * arc.y() : 0.5 * arc.y();
    side = add_straight_steps(planner, body, pace, steps, side, aside, std::max(0, steps - 4));
    side = add_turn_steps(planner, body, side);
    Pace back = pace;
    back.step_length = std::max(0.0, pace.step_length + arc.x() / (steps - shorter));
    side = add_straight_steps(planner, body, back, steps, side, -aside, 0);
  } else {
    side = add_straight_steps(planner, body, pace, steps, side, 0, 0);
  }
  planner.step(side, {0, 0, 0, 0.6});
  return std::move(planner.plan);
}

}  // namespace weft::character
