#include "character/gait.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "character/gait_curves.hpp"
#include "character/gait_steps.hpp"
#include "character/mannequin.hpp"
#include "character/mannequin_skin.hpp"

namespace weft::character {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStraightest = 10;  ///< least bend of a knee [degrees]; legs that snap straight look stiff
constexpr double kLead = 0.5;        ///< share of the recorded lead of the hips; both legs then reach alike
constexpr double kDetour = 0.06;     ///< of a foot that turns with the body, outward [m]
constexpr double kHipSwing = 1.6;    ///< share of the recorded turn of the pelvis: longer legs, and a catwalk
constexpr double kKeysPerSecond = 60;
constexpr double kHalfTrack = 0.048;  ///< ankle from the middle line, of the height; the recording has 0.038, which
                                      ///< would have the thighs touch

std::size_t z(Joint joint) {
  return static_cast<std::size_t>(joint);
}
Quat turned(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

/// What a walk needs to know of a body.
struct Physique {
  std::array<Vec3, kJointCount> joints;
  double height = 0, foot_yaw = 0;
  FootShape foot;
};

Physique physique_of(const Character& mannequin) {
  Physique body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Node& node = mannequin.nodes[j];
    body.joints[j] = node.local.translation();
    if (node.parent >= 0) body.joints[j] += body.joints[static_cast<std::size_t>(node.parent)];
  }
  const Vec3 hip = body.joints[z(Joint::left_upper_leg)], knee = body.joints[z(Joint::left_lower_leg)],
             ankle = body.joints[z(Joint::left_foot)], ball = body.joints[z(Joint::left_toes)] - ankle;
  body.height = hip.z() / 0.530;
  body.foot_yaw = std::atan2(ball.x(), -ball.y());
  const double cm = body.height / 175;
  body.foot.ankle_height = ankle.z();
  body.foot.ball_forward = std::hypot(ball.x(), ball.y());
  body.foot.ball_height = ankle.z() + ball.z();
  body.foot.heel_back = 3.35 * cm;
  body.foot.heel_radius = 2.4 * cm;
  body.foot.leg_length = (knee - hip).norm() + (ankle - knee).norm();
  return body;
}

/// Collects the steps of a walk.
class Planner {
 public:
  Planner(const Physique& body, const Pace& pace, double start)
      : body_(body),
        pace_(pace),
        next_strike_(start + kRise * 2 * pace.step_time + (1 - kStance) * 2 * pace.step_time) {
    plan.period = 2 * pace.step_time;
    for (int side = 0; side < 2; ++side) plan.plants[static_cast<std::size_t>(side)].push_back(plant_of(side));
  }

  /// Moves the middle of the body and sets one foot beside it.
  void step(int side, double forward, double turn, double size) {
    yaw_ += turn;
    middle_ += forward * Vec2(std::sin(yaw_), -std::cos(yaw_));
    auto& plants = plan.plants[static_cast<std::size_t>(side)];
    Plant plant = plant_of(side);
    plant.strike = next_strike_;
    plant.step_size = size;
    const double halfway = yaw_ - 0.5 * turn;
    if (turn != 0) plant.detour = (side == 0 ? kDetour : -kDetour) * Vec2(std::cos(halfway), std::sin(halfway));
    plants.back().off = next_strike_ - (1 - kStance) * plan.period;
    plants.push_back(plant);
    if (side == 0) plan.first_strike = next_strike_;
    plan.end = next_strike_;
    next_strike_ += pace_.step_time;
  }

  void wait(double time) { next_strike_ += time; }

  StepPlan plan;

 private:
  Plant plant_of(int side) const {
    const double sign = side == 0 ? 1 : -1;
    Plant plant;
    plant.at = middle_ + sign * kHalfTrack * body_.height * Vec2(std::cos(yaw_), std::sin(yaw_)) -
               0.0075 * body_.height * Vec2(std::sin(yaw_), -std::cos(yaw_));
    plant.yaw = yaw_ + sign * body_.foot_yaw;
    return plant;
  }

  const Physique& body_;
  Pace pace_;
  Vec2 middle_ = Vec2::Zero();
  double yaw_ = 0, next_strike_;
};

/// An even number.
int keys_of_step(const Pace& pace) {
  return 2 * static_cast<int>(std::round(kKeysPerSecond / 2 * pace.step_time));
}

/// The body in even walking at a moment, as the curves have it; sizes against those of the recording.
struct Sway {
  double phase = 0;
  double size = 0;  ///< 0 standing, 1 walking as fast as recorded
};

/// Samples of a walk at even times, and what becomes of them.
class Walker {
 public:
  Walker(const Physique& body, const StepPlan& plan, const Pace& pace, double arms_out, double begin, int keys)
      : body_(body),
        plan_(plan),
        pace_(pace),
        arms_out_(arms_out),
        begin_(begin),
        step_keys_(keys_of_step(pace)),
        keys_(keys),
        paths_{FootPath(body.foot, plan.plants[0], plan.period), FootPath(body.foot, plan.plants[1], plan.period)} {
    // Filters look beyond both ends.
    const int spare = 4 * step_keys_;
    for (int k = -spare; k < keys + spare; ++k) {
      feet_.push_back({paths_[0].at(time(k)), paths_[1].at(time(k))});
    }
    spare_ = spare;
    lay_ground_track();
    find_heights();
  }

  Clip clip(std::string name) const {
    Clip clip;
    clip.name = std::move(name);
    clip.duration = (keys_ - 1) * key_time();
    clip.channels.resize(kJointCount);
    for (std::size_t j = 0; j < kJointCount; ++j) clip.channels[j].node = static_cast<Index>(j);
    for (int k = 0; k < keys_; ++k) add_key(clip, k);
    return clip;
  }

 private:
  double key_time() const { return pace_.step_time / step_keys_; }
  double time(int k) const { return begin_ + k * key_time(); }
  std::size_t index(int k) const { return static_cast<std::size_t>(k + spare_); }

  /// Mean over `width` keys around each, an even number; half a share at both ends keeps it centred.
  template <class Value>
  static std::vector<Value> mean_around(const std::vector<Value>& values, int width) {
    std::vector<Value> means;
    const int n = static_cast<int>(values.size());
    for (int k = 0; k < n; ++k) {
      Value sum = values[0] * 0;
      for (int d = -width / 2; d <= width / 2; ++d) {
        const double share = std::abs(d) == width / 2 ? 0.5 : 1;
        sum += share / width * values[static_cast<std::size_t>(std::clamp(k + d, 0, n - 1))];
      }
      means.push_back(sum);
    }
    return means;
  }

  /// The middle between the feet, smoothed over a step: even walking gives an even way, start and end are eased.
  void lay_ground_track() {
    std::vector<Vec3> track;
    for (const auto& feet : feet_) {
      const Vec3 middle = 0.5 * (feet[0].ankle + feet[1].ankle);
      track.emplace_back(middle.x(), middle.y(), 0.5 * (feet[0].yaw + feet[1].yaw));
    }
    // Over one step, which takes every ripple of even walking out; then shortly, for smooth velocities.
    const int shortly = step_keys_ / 6 * 2;
    track_ = mean_around(mean_around(mean_around(track, step_keys_), shortly), shortly);
    speeds_.assign(track_.size(), 0);
    for (std::size_t k = 1; k + 1 < track_.size(); ++k) {
      speeds_[k] = (track_[k + 1] - track_[k - 1]).head<2>().norm() / (2 * key_time());
    }
  }

  Sway sway(int k) const {
    const double speed = pace_.step_length / pace_.step_time;
    const double recorded_step = walking::kSpeed * walking::kPeriod / 2 * body_.foot.leg_length / walking::kLegLength;
    const double even = std::clamp(speeds_[index(k)] / speed, 0.0, 1.0);
    return {(time(k) - plan_.first_strike) / plan_.period, even * std::min(pace_.step_length / recorded_step, 1.3)};
  }

  Quat heading(int k) const { return turned(track_[index(k)].z(), Vec3::UnitZ()); }

  /// Yaw to the left, roll with the left side up, pitch forward [degrees].
  static Quat leaning(double yaw, double roll, double pitch) {
    return turned(yaw * kDegree, Vec3::UnitZ()) * turned(-roll * kDegree, Vec3::UnitY()) *
           turned(pitch * kDegree, Vec3::UnitX());
  }

  Quat pelvis_rotation(int k) const {
    const auto [phase, size] = sway(k);
    return heading(k) * leaning(size * kHipSwing * walking::pelvis_yaw.at(phase), size * walking::pelvis_roll.at(phase),
                                size * (walking::pelvis_pitch.at(phase) - walking::pelvis_pitch.mean));
  }

  /// Place of the hips without their height.
  Vec3 pelvis_ground(int k) const {
    const auto [phase, size] = sway(k);
    const double scale = size * body_.foot.leg_length / walking::kLegLength;
    // Standing, the ankles are a little behind the hips; walking, more so.
    const double forward =
        0.0075 * body_.height + scale * (walking::pelvis_forward.at(phase) - walking::pelvis_forward.mean -
                                         kLead * walking::ankle_forward.mean);
    const double left = 0.8 * scale * walking::pelvis_left.at(phase);
    const Vec3& track = track_[index(k)];
    return Vec3(track.x(), track.y(), 0) + heading(k) * Vec3(left, -forward, 0);
  }

  Vec3 hip_offset(int k, int side) const {
    const Joint hip = side == 0 ? Joint::left_upper_leg : Joint::right_upper_leg;
    return pelvis_rotation(k) * (body_.joints[z(hip)] - body_.joints[z(Joint::hips)]);
  }

  /// As high as both legs allow, and smooth: the least within a while, smoothed over the same while, is never more.
  void find_heights() {
    const Vec3 hip = body_.joints[z(Joint::left_upper_leg)], knee = body_.joints[z(Joint::left_lower_leg)],
               ankle = body_.joints[z(Joint::left_foot)];
    const double a = (knee - hip).norm(), b = (ankle - knee).norm();
    const double reach_sq = a * a + b * b + 2 * a * b * std::cos(kStraightest * kDegree);
    std::vector<double> allowed;
    const int n = static_cast<int>(feet_.size());
    for (int i = 0; i < n; ++i) {
      const int k = i - spare_;
      double height = 1e9;
      for (int side = 0; side < 2; ++side) {
        const Vec3 offset = hip_offset(k, side);
        const Vec3 foot = feet_[static_cast<std::size_t>(i)][static_cast<std::size_t>(side)].ankle;
        const Vec3 apart = (pelvis_ground(k) + offset - foot).cwiseProduct(Vec3(1, 1, 0));
        height = std::min(height, foot.z() + std::sqrt(std::max(reach_sq - apart.squaredNorm(), 0.0)) - offset.z());
      }
      allowed.push_back(height);
    }
    const int width = std::max(2, step_keys_ / 8 / 2 * 2);
    heights_.assign(allowed.size(), 0);
    for (int i = 0; i < n; ++i) {
      // Three passes of smoothing reach one and a half widths to both sides.
      double least = allowed[static_cast<std::size_t>(i)];
      for (int d = -3 * width / 2; d <= 3 * width / 2; ++d) {
        least = std::min(least, allowed[static_cast<std::size_t>(std::clamp(i + d, 0, n - 1))]);
      }
      heights_[static_cast<std::size_t>(i)] = least;
    }
    for (int pass = 0; pass < 3; ++pass) heights_ = mean_around(heights_, width);
  }

  /// Rotations of all joints against the world.
  std::array<Quat, kJointCount> rotations(int k, const Vec3& pelvis) const {
    std::array<Quat, kJointCount> global;
    const auto [phase, size] = sway(k);
    const Quat hips = pelvis_rotation(k);
    const Quat chest =
        heading(k) * leaning(size * walking::chest_yaw.at(phase), size * walking::chest_roll.at(phase), 0);
    const Quat head = heading(k) * leaning(size * walking::head_yaw.at(phase), 0, 0);
    global[z(Joint::hips)] = hips;
    global[z(Joint::spine)] = hips.slerp(0.5, chest);
    global[z(Joint::chest)] = chest;
    global[z(Joint::neck)] = chest.slerp(0.5, head);
    global[z(Joint::head)] = head;
    for (int side = 0; side < 2; ++side) {
      arm(global, side, phase + 0.5 * side, size, chest);
      leg(global, k, side, pelvis + hip_offset(k, side));
    }
    return global;
  }

  static Joint of_side(Joint left, int side) {
    return static_cast<Joint>(z(left) + static_cast<std::size_t>(side) * kSideJointCount);
  }

  void arm(std::array<Quat, kJointCount>& global, int side, double phase, double size, const Quat& chest) const {
    const double sign = side == 0 ? 1 : -1;
    const double forward = size * (walking::arm_forward.at(phase) - 0.5 * walking::arm_forward.mean);
    const double out = arms_out_ + 0.5 * size * (walking::arm_out.at(phase) - walking::arm_out.mean);
    const double bend = 10 + size * 0.6 * (walking::elbow.at(phase) - 10);
    // From where the arm hangs at rest, 45° out.
    const Quat upper =
        chest * turned(-forward * kDegree, Vec3::UnitX()) * turned(sign * (45 - out) * kDegree, Vec3::UnitY());
    const Vec3 along(sign * std::sqrt(0.5), 0, -std::sqrt(0.5));
    const Quat lower = upper * turned(bend * kDegree, along.cross(-Vec3::UnitY()));
    global[z(of_side(Joint::left_shoulder, side))] = chest;
    global[z(of_side(Joint::left_upper_arm, side))] = upper;
    global[z(of_side(Joint::left_lower_arm, side))] = lower;
    global[z(of_side(Joint::left_hand, side))] = lower;
  }

  /// The rotation that takes one pair of directions to another, the first exactly.
  static Quat carrying(const Vec3& along0, const Vec3& side0, const Vec3& along1, const Vec3& side1) {
    const auto axes = [](const Vec3& along, const Vec3& side) {
      Mat3 m;
      m.col(0) = along.normalized();
      m.col(1) = (side - side.dot(m.col(0)) * m.col(0)).normalized();
      m.col(2) = m.col(0).cross(m.col(1));
      return m;
    };
    return Quat(Mat3(axes(along1, side1) * axes(along0, side0).transpose()));
  }

  /// Two bones reach from the hip to the ankle; the knee bends about an axis between those of pelvis and foot.
  void leg(std::array<Quat, kJointCount>& global, int k, int side, const Vec3& hip) const {
    const FootState& foot = feet_[index(k)][static_cast<std::size_t>(side)];
    const double sign = side == 0 ? 1 : -1;
    const Vec3 hip0 = body_.joints[z(of_side(Joint::left_upper_leg, side))],
               knee0 = body_.joints[z(of_side(Joint::left_lower_leg, side))],
               ankle0 = body_.joints[z(of_side(Joint::left_foot, side))];
    const double a = (knee0 - hip0).norm(), b = (ankle0 - knee0).norm();
    const Vec3 reach = foot.ankle - hip;
    const double d = std::min(reach.norm(), 0.9999 * (a + b));
    const Quat foot_yaw = turned(foot.yaw - sign * body_.foot_yaw, Vec3::UnitZ());
    const Vec3 along = reach.normalized();
    Vec3 axis = global[z(Joint::hips)].slerp(0.5, foot_yaw) * Vec3::UnitX();
    axis = (axis - axis.dot(along) * along).normalized();
    // Cosine rule; the knee is in front.
    const double cosine = (a * a + d * d - b * b) / (2 * a * d);
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const Vec3 thigh = a * (cosine * along + sine * along.cross(axis).normalized());
    const Vec3 shin = reach - thigh;
    global[z(of_side(Joint::left_upper_leg, side))] = carrying(knee0 - hip0, Vec3::UnitX(), thigh, axis);
    global[z(of_side(Joint::left_lower_leg, side))] = carrying(ankle0 - knee0, Vec3::UnitX(), shin, axis);
    const Vec3 across = turned(foot.yaw, Vec3::UnitZ()) * Vec3::UnitX();
    global[z(of_side(Joint::left_foot, side))] = turned(-foot.pitch, across) * foot_yaw;
    global[z(of_side(Joint::left_toes, side))] = turned(-foot.pitch - foot.toes, across) * foot_yaw;
  }

  void add_key(Clip& clip, int k) const {
    const Vec3 pelvis = pelvis_ground(k) + heights_[index(k)] * Vec3::UnitZ();
    const auto global = rotations(k, pelvis);
    const double t = k * key_time();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto joint = static_cast<Joint>(j);
      const Quat local = joint == Joint::hips ? global[j] : global[z(parent(joint))].conjugate() * global[j];
      clip.channels[j].rotation.times.push_back(t);
      clip.channels[j].rotation.values.push_back(local.normalized());
    }
    clip.channels[0].position.times.push_back(t);
    clip.channels[0].position.values.push_back(pelvis);
  }

  const Physique& body_;
  const StepPlan& plan_;
  Pace pace_;
  double arms_out_, begin_;
  int step_keys_, keys_, spare_ = 0;
  std::array<FootPath, 2> paths_;
  std::vector<std::array<FootState, 2>> feet_;
  std::vector<Vec3> track_;  ///< x, y [m] and yaw [rad]
  std::vector<double> speeds_, heights_;
};

/// How large even steps are against the recorded ones.
double step_size(const Physique& body, const Pace& pace) {
  const double recorded = walking::kSpeed * walking::kPeriod / 2 * body.foot.leg_length / walking::kLegLength;
  return std::clamp(pace.step_length / recorded, 0.5, 1.2);
}

/// From standing to standing; returns the foot that is next.
int walk_ahead(Planner& planner, const Physique& body, const Pace& pace, int steps, int side) {
  const double size = step_size(body, pace);
  for (int k = 0; k < steps; ++k, side = 1 - side) {
    planner.step(side, k == 0 ? 0.6 * pace.step_length : pace.step_length, 0, k == 0 ? 0.75 * size : size);
  }
  planner.step(side, 0, 0, 0.6 * size);
  return 1 - side;
}

}  // namespace

Clip make_walk(const Character& mannequin, const Walk& walk) {
  const Physique body = physique_of(mannequin);
  Pace pace = pace_of(walk.speed, body.height);
  // A whole number of steps, the first of which is shorter.
  const int steps = std::max(2, static_cast<int>(std::round(walk.distance / pace.step_length + 0.4)));
  pace.step_length = walk.distance / (steps - 0.4);
  pace.step_time = pace.step_length / walk.speed;
  Planner planner(body, pace, walk.stand);
  int side = walk_ahead(planner, body, pace, steps, 1);
  if (walk.turn_back) {
    planner.wait(0.5 * walk.stand);
    side = 0;
    // Degrees to the left: the inner foot opens, the outer one follows, so that toes do not meet.
    constexpr std::array<double, 6> turns{60, 10, 60, 10, 40, 0};
    for (const double turn : turns) {
      planner.step(side, 0, turn * kDegree, 0.4);
      side = 1 - side;
    }
    walk_ahead(planner, body, pace, steps, side);
  }
  const double end = planner.plan.end + 0.5 * planner.plan.period + walk.stand;
  const double key_time = pace.step_time / keys_of_step(pace);
  return Walker(body, planner.plan, pace, walk.arms_out, 0, static_cast<int>(end / key_time) + 1).clip("walk");
}

Clip make_stride(const Character& mannequin, const Walk& walk) {
  const Physique body = physique_of(mannequin);
  const Pace pace = pace_of(walk.speed, body.height);
  Planner planner(body, pace, 0);
  constexpr int before = 11;  // steps until nothing of the start is left
  for (int k = 0; k < 2 * before + 2; ++k) planner.step(k % 2, pace.step_length, 0, step_size(body, pace));
  const Plant& first = planner.plan.plants[0][before / 2 + 1];
  const int keys = 2 * keys_of_step(pace) + 1;
  return Walker(body, planner.plan, pace, walk.arms_out, first.strike, keys).clip("stride");
}

}  // namespace weft::character
