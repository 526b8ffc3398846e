#include "film/character/retarget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "film/character/footing.hpp"
#include "film/character/four_legs.hpp"
#include "film/character/parts.hpp"
#include "film/character/pose.hpp"
#include "film/character/touching.hpp"

namespace weft::character {
namespace {

/// Skeletons are the same if no joint position differs by more than kSameLength times the sum of all bone lengths (3 mm
/// in an adult). They have the same heading if the rotations above the hips differ by at most kSameAngle [rad].
constexpr double kSameLength = 1e-3, kSameAngle = 1e-3;

/// Maximum joint angles without a warning [degrees], with a margin for noise and for external forces on limbs. People
/// bend knees and elbows by 150, overextend them by 10, raise thighs by 130, turn the head by 90, tilt it by 45, turn
/// the spine by 45, bend it by 80 (American Academy of Orthopaedic Surgeons, Joint Motion, 1965).
constexpr double kMaxBend = 165, kMaxBackward = 25, kMaxThigh = 160, kMaxHead = 120, kMaxSpine = 120;

/// Maximum knee bend of a rest pose that counts as upright [degrees].
constexpr double kMaxRestBend = 30;

/// Maximum upward rotation of toes on the floor, relative to their direction in the motion [rad].
constexpr double kMaxToeTurn = 150 * kDegree;

/// Maximum distance without a warning between sole and floor during a contact [m].
constexpr double kMaxFloorError = 0.05;

/// Maximum number of rounds that move hands to the parts that they touch. One is not enough: these parts may move, too.
constexpr int kTouchingRounds = 3;
/// Hands do not move if the displacements of both are smaller than this [m].
constexpr double kMinPull = 1e-4;

template <class Value>
using PerJoint = std::array<Value, kJointCount>;

/// Rotation about `up` from the heading of one posture to that of another. `from`, `to`: the vectors to the left of the
/// body in both postures.
Quat heading_rotation(Vec3 from, Vec3 to, const Vec3& up) {
  from -= from.dot(up) * up;
  to -= to.dot(up) * up;
  if (from.norm() < 1e-9 || to.norm() < 1e-9) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(std::atan2(from.cross(to).dot(up), from.dot(to)), up));
}

/// Vector to the left of the body, from the lines through hips and shoulders.
Vec3 to_the_left(const Skeleton& skeleton, const Posture& posture) {
  const Vec3 hips = skeleton.across_hips(posture), shoulders = skeleton.across_shoulders(posture);
  return hips.normalized() + shoulders.normalized();
}

/// Whether two skeletons have the same joints and, up to one common factor, the same joint positions in the axes of
/// their parent nodes. Poses do not change these positions.
bool same_skeleton(const Rig& a, const Rig& b) {
  const auto place = [](const Rig& rig, std::size_t joint) -> Vec3 {
    return rig.character.nodes[rig.joints[joint]].local.translation();
  };
  double size_a = 0, size_b = 0;
  for (std::size_t j = 1; j < kJointCount; ++j) {
    if ((a.joints[j] < 0) != (b.joints[j] < 0)) return false;
    if (a.joints[j] < 0) continue;
    size_a += place(a, j).norm();
    size_b += place(b, j).norm();
  }
  for (std::size_t j = 1; j < kJointCount && size_b > 0; ++j)
    if (a.joints[j] >= 0 && (place(a, j) - size_a / size_b * place(b, j)).norm() > kSameLength * size_a) return false;
  return size_b > 0;
}

/// World rotation of the parent of the hips in the rest pose.
Quat rotation_above_hips(const Rig& rig) {
  const Index hips = rig.joints[joint_index(Joint::hips)];
  return to_placement(parent_transform(rig.character, rest_pose(rig.character), hips)).rotation;
}

/// Pose of the body at one key of the clip.
struct Frame {
  PerJoint<Quat> axes;    ///< axes of the body parts, in the world; see find_anatomy()
  PerJoint<Quat> turned;  ///< rotations of the joints, in the world
  Vec3 hips{0, 0, 0};
};

class Retargeter {
 public:
  Retargeter(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up)
      : body_(body),
        ours_(body),
        theirs_(motion),
        clip_(clip),
        up_(up),
        at_rest_(rest_pose(body.character)),
        rest_(ours_.at(at_rest_)),
        times_(key_times(clip)) {
    for (const double t : times_) postures_.push_back(theirs_.at(pose_at(motion.character, clip, t)));
    const Posture motion_rest = theirs_.at(rest_pose(motion.character));
    ratio_ = size_ratio(ours_, rest_, theirs_, postures_.front());
    same_ = same_skeleton(body, motion);
    if (!same_) steps_ = find_footsteps(theirs_, postures_, times_, up_);
    if (!same_ || rotation_above_hips(body).angularDistance(rotation_above_hips(motion)) > kSameAngle)
      face_ = heading_rotation(to_the_left(theirs_, same_ ? motion_rest : postures_.front()), to_the_left(ours_, rest_),
                               up_);
    find_axes();
    joint_of_.assign(body.character.nodes.size(), -1);
    for (std::size_t j = 0; j < kJointCount; ++j)
      if (moves_[j]) joint_of_[static_cast<std::size_t>(body.joints[j])] = static_cast<int>(j);
  }

  Retargeted run() {
    std::vector<Frame> frames;
    for (std::size_t k = 0; k < times_.size(); ++k) frames.push_back(frame_at(k));
    Retargeted result;
    if (!same_ && can_stand()) plant_both_feet(frames, result.warnings);
    if (!same_) keep_hands_near(frames);
    if (!same_) check_joints(result.warnings);
    if (!same_) check_rest(result.warnings);
    if (!same_)
      if (auto warning = warn_if_on_all_fours(theirs_, postures_, up_)) result.warnings.push_back(*std::move(warning));
    result.clip = {clip_.name, clip_.duration, {}, {}};
    for (std::size_t n = 0; n < joint_of_.size(); ++n)
      if (joint_of_[n] >= 0) result.clip.channels.push_back({static_cast<Index>(n), {}, {}, {}});
    for (std::size_t k = 0; k < times_.size(); ++k) append(times_[k], frames[k], result.clip);
    return result;
  }

 private:
  bool can_stand() const {
    for (const bool right : {false, true})
      for (const Joint joint : {Joint::left_upper_leg, Joint::left_lower_leg, Joint::left_foot})
        if (!moves_[joint_index(on_side(joint, right))]) return false;
    return true;
  }

  void find_axes() {
    their_axes_.fill(Quat::Identity());
    our_axes_ = their_axes_;
    if (!same_) {
      their_axes_ = find_anatomy(theirs_, postures_, steps_.flat, up_);
      const std::vector<Flat> flat{{1, 1}};
      our_axes_ = find_anatomy(ours_, std::span(&rest_, 1), flat, up_);
    }
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto joint = static_cast<Joint>(j);
      moves_[j] = ours_.has(joint) && (theirs_.has(joint) || (!same_ && is_interpolated(joint)));
    }
  }

  /// Whether a joint that the motion lacks gets its rotation from others: spine and neck from neighbours, toes from
  /// feet.
  bool is_interpolated(Joint joint) const {
    for (const bool right : {false, true})
      if (joint == on_side(Joint::left_toes, right)) return theirs_.has(on_side(Joint::left_foot, right));
    return (joint == Joint::spine && theirs_.has(Joint::chest)) ||
           (joint == Joint::neck && theirs_.has(Joint::head) && theirs_.has(Joint::chest));
  }

  Frame frame_at(std::size_t k) const {
    const Posture& posture = postures_[k];
    Frame frame;
    for (std::size_t j = 0; j < kJointCount; ++j)
      frame.axes[j] = (face_ * posture.rotations[j] * their_axes_[j]).normalized();
    for (const Joint joint : {Joint::spine, Joint::neck})
      if (const std::size_t j = joint_index(joint); !theirs_.has(joint) && moves_[j])
        frame.axes[j] = frame.axes[j - 1].slerp(0.5, frame.axes[j + 1]);
    for (const bool right : {false, true})
      if (const Joint toes = on_side(Joint::left_toes, right); !theirs_.has(toes))
        frame.axes[joint_index(toes)] = frame.axes[joint_index(toes) - 1];
    for (std::size_t j = 0; j < kJointCount; ++j)
      frame.turned[j] = (frame.axes[j] * our_axes_[j].conjugate()).normalized();
    frame.hips = hips_at(k, frame);
    return frame;
  }

  Vec3 hips_at(std::size_t k, const Frame& frame) const {
    // Scales the height of the hip midpoint above the ankles with the legs, then computes the hips from this midpoint.
    const Vec3 place = theirs_.middle_of_hips(postures_[k]);
    const Vec3 moved = face_ * (place - theirs_.middle_of_hips(postures_.front()));
    const Vec3 middle = ours_.middle_of_hips(rest_), hips = rest_.places[0];
    const Vec3 level = middle + ratio_ * moved;
    const double height = up_.dot(level) + height_offset(place, middle, moved);
    const Vec3 to = level + (height - up_.dot(level)) * up_;
    return to + frame.turned[0] * (rest_.rotations[0].conjugate() * (hips - middle));
  }

  /// Height to add to the scaled hip midpoint [m], so that feet stand at the height that they have in the rest pose.
  double height_offset(const Vec3& place, const Vec3& middle, const Vec3& moved) const {
    const double travelled = up_.dot(middle) + ratio_ * up_.dot(moved);
    if (same_) {
      double ground = std::numeric_limits<double>::infinity();
      for (const Posture& posture : postures_)
        ground = std::min(ground, theirs_.lowest_height(posture, kFootJoints, up_));
      const double floor = ours_.lowest_height(rest_, kFootJoints, up_);
      return std::isfinite(ground) ? floor + ratio_ * (up_.dot(place) - ground) - travelled : 0;
    }
    double ankles = 0;
    for (const bool right : {false, true})
      ankles += up_.dot(rest_.places[joint_index(on_side(Joint::left_foot, right))]);
    return can_stand() ? ankles / 2 + ratio_ * (up_.dot(place) - steps_.ankle_height) - travelled : 0;
  }

  /// Transforms from node to world of all nodes of the body. If `locals` is given, appends to it the transform of each
  /// node to its parent.
  std::vector<Affine> globals(const Frame& frame, std::vector<Placement>* locals = nullptr) const {
    std::vector<Affine> globals;
    for (std::size_t n = 0; n < joint_of_.size(); ++n) {
      const Index parent_node = body_.character.nodes[n].parent;
      const Affine parent = parent_node < 0 ? Affine::Identity() : globals[parent_node];
      Placement local = at_rest_.nodes[n];
      if (joint_of_[n] >= 0) {
        const Quat turned = frame.turned[static_cast<std::size_t>(joint_of_[n])];
        local.rotation = (to_placement(parent).rotation.conjugate() * turned).normalized();
        if (parent.linear().determinant() < 0) local.rotation.vec().head<2>() *= -1;  // to_placement() mirrors z
        if (joint_of_[n] == 0) local.position = parent.inverse() * frame.hips;
      }
      if (locals != nullptr) locals->push_back(local);
      globals.push_back(parent * local.to_affine());
    }
    return globals;
  }

  /// Appends a key to each channel: the rotation of its joint and, for the hips, the position.
  void append(double t, const Frame& frame, Clip& result) const {
    std::vector<Placement> locals;
    globals(frame, &locals);
    std::size_t channel = 0;
    for (std::size_t n = 0; n < joint_of_.size(); ++n) {
      if (joint_of_[n] < 0) continue;
      Channel& to = result.channels[channel++];
      to.rotation.times.push_back(t);
      to.rotation.values.push_back(locals[n].rotation);
      if (joint_of_[n] != 0) continue;
      to.position.times.push_back(t);
      to.position.values.push_back(locals[n].position);
    }
  }

  /// Height of the soles in the rest pose [m]: that of the lowest vertex or foot joint.
  double floor() const {
    double floor = ours_.lowest_height(rest_, kFootJoints, up_);
    std::vector<Vec3> skin_at_rest(body_.character.mesh.positions.size());
    skin(body_.character, at_rest_, skin_at_rest);
    for (const Vec3& x : skin_at_rest) floor = std::min(floor, up_.dot(x));
    return floor;
  }

  Legs legs_of(const Frame& frame, double floor) const {
    const std::vector<Affine> nodes = globals(frame);
    Legs legs;
    for (const bool right : {false, true}) {
      const auto place = [&](Joint left) -> Vec3 {
        return nodes[body_.joints[joint_index(on_side(left, right))]].translation();
      };
      const std::size_t foot = joint_index(on_side(Joint::left_foot, right));
      const Joint toes = ours_.has(on_side(Joint::left_toes, right)) ? Joint::left_toes : Joint::left_foot;
      const auto above_sole = [&](Joint left) {
        return up_.dot(rest_.places[joint_index(on_side(left, right))]) - floor;
      };
      const Vec3 normal = frame.axes[foot] * Vec3::UnitZ();
      Leg& leg = legs[right];
      leg.hip = place(Joint::left_upper_leg);
      leg.knee = place(Joint::left_lower_leg);
      leg.ankle = place(Joint::left_foot);
      leg.heel = leg.ankle - above_sole(Joint::left_foot) * normal;
      // Toes are flat while the heel rises. The ball is therefore vertically below the toe joint.
      leg.ball = place(toes) - above_sole(toes) * (toes == Joint::left_toes ? up_ : normal);
      leg.hinge = frame.axes[joint_index(on_side(Joint::left_lower_leg, right))] * Vec3::UnitX();
    }
    return legs;
  }

  void plant_both_feet(std::vector<Frame>& frames, std::vector<std::string>& warnings) {
    const double sole = floor();
    for (const bool right : {false, true}) toe_length_[right] = toe_length(right);
    std::vector<Legs> legs;
    for (const Frame& frame : frames) legs.push_back(legs_of(frame, sole));
    const std::vector<Stance> stances = plant_feet(legs, steps_, times_, sole, up_);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Stance& stance = stances[k];
      frames[k].hips += stance.rise * up_;
      for (const bool right : {false, true}) {
        Leg leg = legs[k][right];
        const Vec3 ankle = leg.ankle + stance.shift[right];
        for (Vec3* joint : {&leg.hip, &leg.knee, &leg.ankle}) *joint += stance.rise * up_;
        if (ankle != leg.ankle) bend_limb(frames[k], leg, ankle, on_side(Joint::left_upper_leg, right));
        bend_toes(frames[k], legs[k][right].ball + stance.shift[right], sole, right);
      }
    }
    check_floor(frames, stances, sole, warnings);
  }

  void check_floor(const std::vector<Frame>& frames, const std::vector<Stance>& stances, double sole,
                   std::vector<std::string>& warnings) const {
    double worst = 0, when = 0;
    std::size_t in_air = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Legs legs = legs_of(frames[k], sole);
      const auto above = [&](const Leg& leg) { return std::min(up_.dot(leg.ball), up_.dot(leg.heel)) - sole; };
      if (std::min(above(legs[0]), above(legs[1])) > kMaxFloorError) ++in_air;
      for (const bool right : {false, true}) {
        const double gap = above(legs[right]);
        if (!stances[k].in_contact[right] || std::abs(gap) <= std::abs(worst)) continue;
        worst = gap;
        when = times_[k];
      }
    }
    if (std::abs(worst) > kMaxFloorError)
      warnings.push_back(fmt::format("a foot that stands is {:.3g} m {} the floor at {:.3g} s of the motion",
                                     std::abs(worst), worst > 0 ? "above" : "below", when));
    if (2 * in_air > frames.size())
      warnings.push_back(fmt::format("in {:.0f} % of the motion both feet are more than {:g} m above the floor",
                                     100.0 * static_cast<double>(in_air) / static_cast<double>(frames.size()),
                                     kMaxFloorError));
  }

  /// Bends a leg or an arm so that it ends at `end`.
  static void bend_limb(Frame& frame, const Leg& limb, const Vec3& end, Joint upper_joint) {
    const LegTurns turns = solve_two_bone_ik(limb, end);
    Quat& upper = frame.turned[joint_index(upper_joint)];
    Quat& lower = frame.turned[joint_index(upper_joint) + 1];
    upper = (turns.upper * upper).normalized();
    lower = (turns.lower * lower).normalized();
  }

  void keep_hands_near(std::vector<Frame>& frames) const {
    double trunk = 0;  // largest length of the trunk in the motion [m]
    for (const Posture& posture : postures_) trunk = std::max(trunk, theirs_.trunk(posture).norm());
    const double our_arm = ours_.arm_length(rest_), their_arm = theirs_.arm_length(postures_.front());
    if (our_arm == 0 || their_arm == 0 || trunk == 0) return;
    const Proportions proportions{our_arm / their_arm, ours_.trunk(rest_).norm() / trunk, their_arm};
    PerJoint<bool> both{};
    for (std::size_t j = 0; j < kJointCount; ++j) both[j] = moves_[j] && theirs_.has(static_cast<Joint>(j));
    const auto rests = find_resting_hands(postures_, times_, their_arm);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      Places theirs, ours;
      for (std::size_t j = 0; j < kJointCount; ++j) theirs[j] = face_ * postures_[k].places[j];
      for (int round = 0; round < kTouchingRounds; ++round) {
        const std::vector<Affine> nodes = globals(frames[k]);
        for (std::size_t j = 0; j < kJointCount; ++j)
          ours[j] = both[j] ? Vec3(nodes[body_.joints[j]].translation()) : Vec3(Vec3::Zero());
        const std::array<Vec3, 2> pull = displace_hands(theirs, ours, both, proportions, rests[k]);
        if (std::max(pull[0].norm(), pull[1].norm()) < kMinPull) break;
        for (const bool right : {false, true}) {
          const std::size_t upper = joint_index(on_side(Joint::left_upper_arm, right));
          if (pull[right].isZero()) continue;
          Leg arm;
          arm.hip = ours[upper], arm.knee = ours[upper + 1], arm.ankle = ours[upper + 2];
          arm.hinge = frames[k].axes[upper + 1] * Vec3::UnitX();
          bend_limb(frames[k], arm, arm.ankle + pull[right], static_cast<Joint>(upper));
        }
      }
    }
  }

  /// Bends toes up so that they do not enter the floor.
  void bend_toes(Frame& frame, const Vec3& ball, double floor, bool right) const {
    const std::size_t toes = joint_index(on_side(Joint::left_toes, right));
    if (!moves_[toes] || toe_length_[right] <= 0) return;
    const Vec3 forward = frame.axes[toes] * Vec3::UnitX(), normal = frame.axes[toes] * Vec3::UnitZ();
    // If toes are rotated up by an angle, their tip is length · (cos(angle) · down + sin(angle) · back) below their
    // joint.
    const double down = -up_.dot(forward), back = -up_.dot(normal);
    const double limit = std::max(0.0, (up_.dot(ball) - floor) / toe_length_[right]), size = std::hypot(down, back);
    if (down <= limit || size <= limit) return;
    const double angle = std::atan2(back, down) + std::acos(limit / size);
    const Quat turn(Eigen::AngleAxisd(std::min(angle, kMaxToeTurn), forward.cross(normal)));
    frame.turned[toes] = (turn * frame.turned[toes]).normalized();
  }

  /// Distance from the toe joint to the tip of the toes in the rest pose [m].
  double toe_length(bool right) const {
    const std::size_t toes = joint_index(on_side(Joint::left_toes, right));
    if (body_.joints[toes] < 0) return 0;
    const Vec3 forward = rest_.rotations[toes] * (our_axes_[toes] * Vec3::UnitX());
    const VertexMask mask = vertices_below(body_.character, body_.joints[toes]);
    std::vector<Vec3> at_rest(mask.size());
    skin(body_.character, at_rest_, at_rest);
    double length = 0;
    for (std::size_t v = 0; v < mask.size(); ++v)
      if (mask[v] != 0) length = std::max(length, forward.dot(at_rest[v] - rest_.places[toes]));
    return length;
  }

  /// Warns if a joint angle exceeds `limit` [degrees]. `angle(posture)`: the angle [rad].
  template <class Angle>
  void check_joint(const std::string& what, double limit, const Angle& angle,
                   std::vector<std::string>& warnings) const {
    double worst = 0, when = 0;
    for (std::size_t k = 0; k < times_.size(); ++k) {
      const double here = angle(postures_[k]) / kDegree;
      if (here <= worst) continue;
      worst = here;
      when = times_[k];
    }
    if (worst > limit)
      warnings.push_back(
          fmt::format("{} by {:.0f}° at {:.3g} s of the motion; people reach {:.0f}°", what, worst, when, limit));
  }

  void check_joints(std::vector<std::string>& warnings) const {
    const auto axis = [&](const Posture& p, Joint joint, const Vec3& of) -> Vec3 {
      return p.rotations[joint_index(joint)] * (their_axes_[joint_index(joint)] * of);
    };
    const auto lean = [&](Joint a, Joint b, const std::string& what, double limit) {
      if (theirs_.has(a) && theirs_.has(b))
        check_joint(
            what, limit,
            [&](const Posture& p) { return angle_between(axis(p, a, Vec3::UnitZ()), axis(p, b, Vec3::UnitZ())); },
            warnings);
    };
    lean(Joint::hips, Joint::chest, "the chest leans against the hips", kMaxSpine);
    lean(Joint::chest, Joint::head, "the head leans against the chest", kMaxHead);
    for (const bool right : {false, true}) {
      if (const Joint thigh = on_side(Joint::left_upper_leg, right); theirs_.has(thigh))
        check_joint(
            fmt::format("{} goes up", name(thigh)), kMaxThigh,
            [&](const Posture& p) {
              return angle_between(-axis(p, Joint::hips, Vec3::UnitZ()), theirs_.bone(p, thigh));
            },
            warnings);
      for (const Joint left : {Joint::left_lower_arm, Joint::left_lower_leg}) {
        const Joint lower = on_side(left, right), upper = static_cast<Joint>(joint_index(lower) - 1);
        if (!theirs_.has(lower) || !theirs_.has(upper)) continue;
        const auto bend = [&](const Posture& p) {
          return angle_between(theirs_.bone(p, upper), theirs_.bone(p, lower));
        };
        const auto backward = [&](const Posture& p) {
          const Vec3 hinge = theirs_.bone(p, upper).cross(theirs_.bone(p, lower));
          return hinge.dot(axis(p, lower, Vec3::UnitX())) < 0 ? bend(p) : 0;
        };
        check_joint(fmt::format("{} bends", name(lower)), kMaxBend, bend, warnings);
        check_joint(fmt::format("{} bends backward", name(lower)), kMaxBackward, backward, warnings);
      }
    }
  }

  /// Warns if a knee is bent in the rest pose of the body, because all rotations are relative to this pose.
  void check_rest(std::vector<std::string>& warnings) const {
    double largest = 0;
    for (const bool right : {false, true}) {
      const Joint thigh = on_side(Joint::left_upper_leg, right), shin = on_side(Joint::left_lower_leg, right);
      if (!ours_.has(thigh) || !ours_.has(shin) || !ours_.has(on_side(Joint::left_foot, right))) continue;
      largest = std::max(largest, angle_between(ours_.bone(rest_, thigh), ours_.bone(rest_, shin)) / kDegree);
    }
    if (largest > kMaxRestBend)
      warnings.push_back(
          fmt::format("the body of the file stands with a knee bent by {:.0f}°, so that feet will not stand well; "
                      "motions of others "
                      "ask for one that stands upright",
                      largest));
  }

  const Rig body_;
  const Skeleton ours_, theirs_;
  const Clip& clip_;
  const Vec3 up_;
  const Pose at_rest_;  // rest pose of the body
  const Posture rest_;
  const std::vector<double> times_;
  std::vector<Posture> postures_;  // postures of the motion at `times_`
  double ratio_ = 1;               // size_ratio()
  bool same_ = false;              // whether both skeletons are the same
  Footsteps steps_;
  std::array<double, 2> toe_length_{};    // [m]
  Quat face_ = Quat::Identity();          // rotates the motion to the heading of the body
  PerJoint<Quat> their_axes_, our_axes_;  // axes of body parts in the axes of the joints
  PerJoint<bool> moves_{};                // whether the clip moves the joint of the body
  std::vector<int> joint_of_;             // joint of each node of the body, or -1
};

}  // namespace

Retargeted retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up) {
  return Retargeter(body, motion, clip, up).run();
}

Vec3 mean_trunk(const Rig& motion, const Clip& clip) {
  const Skeleton skeleton(motion);
  if (!skeleton.has(Joint::hips)) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  const std::vector<double> times = key_times(clip);
  for (const double t : times) sum += skeleton.trunk(skeleton.at(pose_at(motion.character, clip, t))).normalized();
  return sum / static_cast<double>(times.size());
}

}  // namespace weft::character
