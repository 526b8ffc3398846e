#include "film/character/gait.hpp"

#include <algorithm>
#include <cmath>

#include "film/character/gait_curves.hpp"
#include "film/character/gait_feet.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/mannequin_skin.hpp"

namespace weft::character {
namespace {

constexpr double kHipSwing = 1.6;  ///< factor on the recorded pelvis yaw; above 1 for longer legs and a catwalk gait
constexpr double kShoulderSwing = 1.5;  ///< factor on the recorded chest yaw, which is opposite to that of the pelvis
constexpr double kChestNod = 0.8, kHeadNod = -0.4,
                 kHeadRoll = -0.4;  ///< ratios of pitch (chest / pelvis, head / pelvis) and of roll (head / chest)
constexpr double kShoulderTurnRatio = 0.12;  ///< rotation of a shoulder / rotation of its arm
// The elbows of hanging arms are bent by kElbowAtRest. Walking adds kElbowRatio times the difference between the
// recorded bend and kElbowAtRest. The mean angle of the upper arms from the vertical is Walk::arms_out. The forearms
// are turned back toward the vertical by kForearmTurnRatio times this angle, but at most by kMaxForearmTurn, and less
// beside wide hips. Angles in degrees.
constexpr double kElbowAtRest = 14, kElbowRatio = 0.75, kForearmTurnRatio = 0.75, kMaxForearmTurn = 4.5;
/// Minimum distance from the skin of the hips to the middle of a hanging hand, for a body height of 175 cm [cm].
constexpr double kHandClearance = 8;
// Lead times of the rotation of chest and head in a turn, relative to the hips [s]. The head rotates first, then the
// chest, then the hips (Patla, Adkin & Ballard, "Online steering: coordination and control of body center of mass, head
// and body reorientation", 1999).
constexpr double kChestLead = 0.12, kHeadLead = 0.28;

Quat axis_rotation(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

/// Phase and relative size of the walking motion at one key.
struct Sway {
  double phase = 0;
  double size = 0;  ///< 0: standing; 1: step length / leg length as in the recording; at most 1.3
};

/// Computes the keys of a walk from feet, track and curves.
class Walker {
 public:
  /// Uses the first `keys` keys of the plan.
  Walker(const Physique& body, const StepPlan& plan, double arms_out, int keys)
      : body_(body), plan_(plan), arms_out_(arms_out), keys_(keys) {
    // Feet and balance_body() need keys before the first and after the last key.
    const int margin = 2 * plan.period();
    forearm_turn_ = turn_of_forearms();
    track_ = balance_body(body, plan, -margin, keys + margin);
    for (int key = track_.first; key <= track_.last(); ++key) hips_.push_back({hip_offset(key, 0), hip_offset(key, 1)});
  }

  Clip clip() const {
    const Feet feet(body_, plan_, track_, hips_);
    Clip clip;
    clip.name = "walk";
    clip.duration = (keys_ - 1) * plan_.key_time;
    clip.channels.resize(kJointCount);
    for (std::size_t j = 0; j < kJointCount; ++j) clip.channels[j].node = static_cast<Index>(j);
    for (int key = 0; key < keys_; ++key) add_key(clip, feet, key);
    return clip;
  }

 private:
  Sway sway(int key) const {
    const double recorded_step = walking::kSpeed * walking::kPeriod / 2 * body_.leg() / walking::kLegLength;
    const double step = plan_.speed * plan_.key_time * plan_.step_keys;
    const double relative_speed = std::min(track_.speed[track_.index(key)], 1.0);
    return {track_.phase[track_.index(key)], relative_speed * std::min(step / recorded_step, 1.3)};
  }

  /// Heading of the body at the time `ahead` [s] after the key.
  Quat heading(int key, double ahead = 0) const {
    return axis_rotation(track_.yaw_at(key + static_cast<int>(std::round(ahead / plan_.key_time))), Vec3::UnitZ());
  }

  /// Rotation by yaw, roll and pitch [degrees]. Positive: to the left, left side up, forward.
  static Quat tilt_rotation(double yaw, double roll, double pitch) {
    return axis_rotation(yaw * kDegree, Vec3::UnitZ()) * axis_rotation(-roll * kDegree, Vec3::UnitY()) *
           axis_rotation(pitch * kDegree, Vec3::UnitX());
  }

  Quat pelvis_rotation(int k) const {
    const auto [phase, size] = sway(k);
    return heading(k) * tilt_rotation(size * kHipSwing * walking::pelvis_yaw.at(phase),
                                      size * walking::pelvis_roll.at(phase),
                                      size * (walking::pelvis_pitch.at(phase) - walking::pelvis_pitch.mean));
  }

  /// Index of the joint `left` or, on the side 1, of its mirror image.
  static std::size_t index_on(Joint left, int side) { return joint_index(on_side(left, side != 0)); }

  Vec3 hip_offset(int k, int side) const {
    return pelvis_rotation(k) *
           (body_.joints[index_on(Joint::left_upper_leg, side)] - body_.joints[joint_index(Joint::hips)]);
  }

  /// World rotations of all joints.
  std::array<Quat, kJointCount> rotations(const Feet& feet, int k, const Vec3& pelvis) const {
    std::array<Quat, kJointCount> global;
    const auto [phase, size] = sway(k);
    const Quat hips = pelvis_rotation(k);
    const double nod = size * (walking::pelvis_pitch.at(phase) - walking::pelvis_pitch.mean);
    const double roll = size * walking::chest_roll.at(phase);
    const Quat chest = heading(k, kChestLead) *
                       tilt_rotation(size * kShoulderSwing * walking::chest_yaw.at(phase), roll, kChestNod * nod);
    // The head yaws less than the chest, and its pitch and roll are opposite to those of the chest, which keeps the
    // gaze steady.
    const Quat head =
        heading(k, kHeadLead) * tilt_rotation(size * walking::head_yaw.at(phase), kHeadRoll * roll, kHeadNod * nod);
    global[joint_index(Joint::hips)] = hips;
    global[joint_index(Joint::spine)] = hips.slerp(0.5, chest);
    global[joint_index(Joint::chest)] = chest;
    global[joint_index(Joint::neck)] = chest.slerp(0.5, head);
    global[joint_index(Joint::head)] = head;
    for (int side = 0; side < 2; ++side) {
      arm(global, side, phase + 0.5 * side, size, chest);
      leg(global, feet.at(side, k), side, pelvis + hip_offset(k, side));
    }
    return global;
  }

  /// Outward rotation of the forearms relative to the upper arms [degrees]. It is negative (inward), unless wide hips
  /// require more clearance.
  double turn_of_forearms() const {
    const auto at = [this](Joint joint) { return body_.joints[joint_index(joint)]; };
    const Vec3 &shoulder = at(Joint::left_upper_arm), &elbow = at(Joint::left_lower_arm), &wrist = at(Joint::left_hand);
    const double cm = body_.height / 175, hand = (wrist - elbow).norm() + 8 * cm;
    const double wanted = body_.hips_half_width + kHandClearance * cm;
    const double aside = wanted - shoulder.x() - (elbow - shoulder).norm() * std::sin(arms_out_ * kDegree);
    const double min_turn = std::asin(std::clamp(aside / hand, -1.0, 1.0)) / kDegree;
    return std::max(-std::min(kForearmTurnRatio * arms_out_, kMaxForearmTurn), min_turn - arms_out_);
  }

  void arm(std::array<Quat, kJointCount>& global, int side, double phase, double size, const Quat& chest) const {
    const double sign = side == 0 ? 1 : -1;
    const double forward = size * (walking::arm_forward.at(phase) - 0.5 * walking::arm_forward.mean);
    const double out = arms_out_ + 0.5 * size * (walking::arm_out.at(phase) - walking::arm_out.mean);
    const double bend = kElbowAtRest + size * kElbowRatio * (walking::elbow.at(phase) - kElbowAtRest);
    // Rotates an arm from its rest pose, 45° from the vertical, to the angle `from_vertical` [degrees].
    const auto hanging = [&](double from_vertical) {
      return chest * axis_rotation(-forward * kDegree, Vec3::UnitX()) *
             axis_rotation(sign * (45 - from_vertical) * kDegree, Vec3::UnitY());
    };
    const Quat upper = hanging(out);
    const Vec3 along(sign * std::sqrt(0.5), 0, -std::sqrt(0.5));
    const Quat lower = hanging(out + forearm_turn_) * axis_rotation(bend * kDegree, along.cross(-Vec3::UnitY()));
    global[index_on(Joint::left_shoulder, side)] =
        chest * axis_rotation(-sign * kShoulderTurnRatio * forward * kDegree, Vec3::UnitZ());
    global[index_on(Joint::left_upper_arm, side)] = upper;
    global[index_on(Joint::left_lower_arm, side)] = lower;
    global[index_on(Joint::left_hand, side)] = lower;
  }

  /// The rotation that maps the direction along0 exactly to along1, and side0 as close as possible to side1.
  static Quat rotation_between_frames(const Vec3& along0, const Vec3& side0, const Vec3& along1, const Vec3& side1) {
    const auto axes = [](const Vec3& along, const Vec3& side) {
      Mat3 m;
      m.col(0) = along.normalized();
      m.col(1) = (side - side.dot(m.col(0)) * m.col(0)).normalized();
      m.col(2) = m.col(0).cross(m.col(1));
      return m;
    };
    return Quat(Mat3(axes(along1, side1) * axes(along0, side0).transpose()));
  }

  /// Two-bone inverse kinematics from hip to ankle. The knee axis is halfway between the x axes of pelvis and foot.
  void leg(std::array<Quat, kJointCount>& global, const FootState& foot, int side, const Vec3& hip) const {
    const double sign = side == 0 ? 1 : -1;
    const Vec3 hip0 = body_.joints[index_on(Joint::left_upper_leg, side)],
               knee0 = body_.joints[index_on(Joint::left_lower_leg, side)],
               ankle0 = body_.joints[index_on(Joint::left_foot, side)];
    const double a = (knee0 - hip0).norm(), b = (ankle0 - knee0).norm();
    const Vec3 to_ankle = foot.ankle - hip;
    const double d = std::min(to_ankle.norm(), 0.9999 * (a + b));
    const Quat foot_yaw = axis_rotation(foot.yaw, Vec3::UnitZ());
    const Vec3 along = to_ankle.normalized();
    Vec3 axis = global[joint_index(Joint::hips)].slerp(0.5, foot_yaw) * Vec3::UnitX();
    axis = (axis - axis.dot(along) * along).normalized();
    // The law of cosines has two solutions. Uses that with the knee in front.
    const double cosine = (a * a + d * d - b * b) / (2 * a * d);
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const Vec3 thigh = a * (cosine * along + sine * along.cross(axis).normalized());
    const Vec3 shin = to_ankle - thigh;
    global[index_on(Joint::left_upper_leg, side)] = rotation_between_frames(knee0 - hip0, Vec3::UnitX(), thigh, axis);
    global[index_on(Joint::left_lower_leg, side)] = rotation_between_frames(ankle0 - knee0, Vec3::UnitX(), shin, axis);
    const Vec3 across = axis_rotation(foot.yaw + sign * body_.foot_yaw, Vec3::UnitZ()) * Vec3::UnitX();
    global[index_on(Joint::left_foot, side)] = axis_rotation(-foot.pitch, across) * foot_yaw;
    global[index_on(Joint::left_toes, side)] = axis_rotation(-foot.pitch - foot.toes, across) * foot_yaw;
  }

  void add_key(Clip& clip, const Feet& feet, int key) const {
    const Vec2& place = track_.place[track_.index(key)];
    const Vec3 pelvis(place.x(), place.y(), feet.pelvis_height(key));
    const auto global = rotations(feet, key, pelvis);
    const double t = key * plan_.key_time;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto joint = static_cast<Joint>(j);
      const Quat local = joint == Joint::hips ? global[j] : global[joint_index(parent(joint))].conjugate() * global[j];
      clip.channels[j].rotation.times.push_back(t);
      clip.channels[j].rotation.values.push_back(local.normalized());
    }
    clip.channels[0].position.times.push_back(t);
    clip.channels[0].position.values.push_back(pelvis);
  }

  const Physique& body_;
  const StepPlan& plan_;
  double arms_out_;
  double forearm_turn_ = 0;  // outward rotation of the forearms relative to the upper arms [degrees]
  int keys_;
  Track track_;
  HipOffsets hips_;
};

}  // namespace

Clip make_walk(const Character& mannequin, const Walk& walk) {
  const Physique body = physique_of(mannequin);
  const StepPlan plan = plan_walk(body, walk);
  const int stand = static_cast<int>(std::round(walk.stand / plan.key_time));
  return Walker(body, plan, walk.arms_out, plan.strikes.back().key + plan.period() * 9 / 10 + stand + 1).clip();
}

}  // namespace weft::character
