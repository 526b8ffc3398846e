#include "character/gait_steps.hpp"

#include <algorithm>
#include <cmath>

#include "character/gait_curves.hpp"

namespace weft::character {
namespace {

constexpr double kKeysPerSecond = 60;
constexpr double kHalfTrack = 0.048;  ///< ankle from the middle line, of the height; the recording has 0.038, which
                                      ///< would have the thighs touch
constexpr double kAside = 0.07;       ///< of a foot that turns with the body, outward [m]
constexpr double kFirst = 0.65, kLast = 0.75;  ///< lengths of the first and the last step, of an even one
constexpr double kShift = 0.45;                ///< share of a stride to shift the weight before a first step

/// What is walked around: the turn leads along a small arc, degrees to the side of the foot that begins. The inner foot
/// opens, the outer one follows, so that toes do not meet.
constexpr std::array<double, 4> kTurns{54, 36, 54, 36};
constexpr double kTurnStep = 0.11;  ///< forward in each step of a turn [m], for a height of 1.75 m

Vec2 forward_of(double yaw) {
  return {std::sin(yaw), -std::cos(yaw)};
}
Vec2 left_of(double yaw) {
  return {std::cos(yaw), std::sin(yaw)};
}

/// How large even steps are against the recorded ones.
double step_size(const Physique& body, const Pace& pace) {
  const double recorded = walking::kSpeed * walking::kPeriod / 2 * body.leg() / walking::kLegLength;
  return std::clamp(pace.step_length / recorded, 0.5, 1.2);
}

/// One step: how the body goes on from the step before, and the foot beside it.
struct Step {
  double forward = 0, left = 0;  ///< [m]
  double turn = 0;               ///< [rad]
  double size = 1;
};

/// Collects the steps of a walk.
class Planner {
 public:
  Planner(const Physique& body, const Pace& pace, double stand) : body_(body) {
    plan.step_keys = keys_of_step(pace);
    plan.key_time = pace.step_time / plan.step_keys;
    plan.speed = pace.step_length / pace.step_time;
    next_strike_ = static_cast<int>(std::round(stand / plan.key_time)) + share(kShift) + share(kSwing);
    for (int side = 0; side < 2; ++side) plan.plants[side].push_back(plant_of(side));
  }

  /// Moves the middle of the body and sets one foot beside it.
  void step(int side, const Step& step) {
    yaw_ += step.turn;
    middle_ += step.forward * forward_of(yaw_) + step.left * left_of(yaw_);
    auto& plants = plan.plants[side];
    Plant plant = plant_of(side);
    plant.strike = next_strike_;
    plant.size = step.size;
    if (step.turn != 0) plant.aside = kAside;
    plants.back().off = next_strike_ - share(kSwing);
    plants.push_back(plant);
    plan.strikes.push_back({next_strike_, side});
    next_strike_ += plan.step_keys;
  }

  StepPlan plan;

 private:
  int share(double of_stride) const { return static_cast<int>(std::round(of_stride * plan.period())); }

  Plant plant_of(int side) const {
    const double sign = side == 0 ? 1 : -1;
    Plant plant;
    plant.at = middle_ + sign * kHalfTrack * body_.height * left_of(yaw_) - body_.stance_forward * forward_of(yaw_);
    plant.yaw = yaw_;
    plant.foot_yaw = yaw_ + sign * body_.foot_yaw;
    return plant;
  }

  const Physique& body_;
  Vec2 middle_ = Vec2::Zero();
  double yaw_ = 0;
  int next_strike_ = 0;
};

/// The steps of a straight way; `left`: how far the way leads aside, over the steps from `from` on, four at most.
/// Returns the foot that is next.
int go_ahead(Planner& planner, const Physique& body, const Pace& pace, int steps, int side, double left, int from) {
  const int aside = std::min(4, steps);
  for (int k = 0; k < steps; ++k, side = 1 - side) {
    Step step;
    step.size = step_size(body, pace);
    step.forward = pace.step_length * (k == 0 ? kFirst : k + 1 == steps ? kLast : 1);
    if (k == 0) step.size *= 0.8;
    if (k >= from && k < from + aside) step.left = left / aside;
    planner.step(side, step);
  }
  return side;
}

/// Half a turn on a small arc; returns the foot that is next.
int turn_round(Planner& planner, const Physique& body, int side) {
  const double sign = side == 0 ? 1 : -1, forward = kTurnStep * body.height / 1.75;
  for (const double turn : kTurns) {
    planner.step(side, {forward, 0, sign * turn * kDegree, 0.5});
    side = 1 - side;
  }
  return side;
}

/// How far the arc of a turn to the left leads ahead and to the left, before the turn [m].
Vec2 arc_of_turn(const Physique& body) {
  double yaw = 0;
  Vec2 way = Vec2::Zero();
  for (const double turn : kTurns) {
    yaw += turn * kDegree;
    way += kTurnStep * body.height / 1.75 * Vec2(std::cos(yaw), std::sin(yaw));
  }
  return way;
}

}  // namespace

Physique physique_of(const Character& mannequin) {
  const auto z = [](Joint joint) { return static_cast<std::size_t>(joint); };
  Physique body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Node& node = mannequin.nodes[j];
    body.joints[j] = node.local.translation();
    if (node.parent >= 0) body.joints[j] += body.joints[node.parent];
  }
  const Vec3 hip = body.joints[z(Joint::left_upper_leg)], knee = body.joints[z(Joint::left_lower_leg)],
             ankle = body.joints[z(Joint::left_foot)], ball = body.joints[z(Joint::left_toes)] - ankle;
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
  // Arms are farther out at rest.
  for (const Vec3& p : mannequin.mesh.positions)
    if (p.z() > 75 * cm && p.z() < 98 * cm && p.x() < 35 * cm)
      body.hips_half_width = std::max(body.hips_half_width, p.x());
  return body;
}

Pace pace_of(double speed, double height) {
  constexpr double walk_ratio = 0.0062;     // m/(steps/min), of the recording
  constexpr double recorded_height = 1.70;  // m; from the walker's legs
  const double length = std::sqrt(walk_ratio * height / recorded_height * 60 * speed);
  return {length, length / speed};
}

int keys_of_step(const Pace& pace) {
  return 2 * static_cast<int>(std::round(kKeysPerSecond / 2 * pace.step_time));
}

std::size_t StepPlan::plant_at(int side, int key) const {
  const auto& list = plants[side];
  std::size_t plant = 0;
  while (plant + 1 < list.size() && key >= list[plant + 1].strike) ++plant;
  return plant;
}

StepPlan plan_walk(const Physique& body, const Walk& walk) {
  Pace pace = pace_of(walk.speed, body.height);
  // A whole number of steps, of which the first and the last are shorter.
  constexpr double shorter = 2 - kFirst - kLast;
  const int steps = std::max(2, static_cast<int>(std::round(walk.distance / pace.step_length + shorter)));
  pace.step_length = walk.distance / (steps - shorter);
  pace.step_time = pace.step_length / walk.speed;
  Planner planner(body, pace, walk.stand);
  int side = 1;
  if (walk.turn_back) {
    // Half of the way that the turn leads aside is gone before it, half after it.
    const Vec2 arc = arc_of_turn(body);
    // The first step of the turn still goes ahead.
    const double ahead = std::cos(kTurns[0] * kDegree) * kTurnStep * body.height / 1.75;
    pace.step_length -= ahead / (steps - shorter);
    const double aside = (1 + steps) % 2 == 0 ? -0.5 * arc.y() : 0.5 * arc.y();
    side = go_ahead(planner, body, pace, steps, side, aside, std::max(0, steps - 4));
    side = turn_round(planner, body, side);
    Pace back = pace;
    back.step_length += arc.x() / (steps - shorter);
    side = go_ahead(planner, body, back, steps, side, -aside, 0);
  } else {
    side = go_ahead(planner, body, pace, steps, side, 0, 0);
  }
  planner.step(side, {0, 0, 0, 0.6});
  return std::move(planner.plan);
}

}  // namespace weft::character
