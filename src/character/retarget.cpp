#include "character/retarget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "character/joints.hpp"
#include "character/pose.hpp"

namespace weft::character {
namespace {

/// Keys of different joints that are closer than this are one [s].
constexpr double kSameTime = 1e-6;

Quat rotation_of(const Affine& map) {
  return to_placement(map).rotation;
}

/// Joints of a skeleton at a moment; only those that are there may be asked for.
struct Joints {
  std::vector<Affine> globals;  // of all nodes
  std::span<const Index> nodes;

  bool has(Index joint) const { return nodes[joint] >= 0; }
  bool has(const std::string& joint) const { return has(joint_number(joint)); }
  const Affine& global(Index joint) const { return globals[nodes[joint]]; }
  Vec3 place(const std::string& joint) const { return global(joint_number(joint)).translation(); }
  Vec3 from_to(const std::string& a, const std::string& b) const {
    return has(a) && has(b) ? Vec3(place(b) - place(a)) : Vec3(Vec3::Zero());
  }
};

Joints joints_at(const Rig& rig, const Pose& pose) {
  return {global_transforms(rig.character, pose), rig.joints};
}

/// From the right of the body to its left, level.
Vec3 to_the_left(const Joints& joints, const Vec3& up) {
  for (const char* part : {"UpperLeg", "UpperArm", "Shoulder"}) {
    Vec3 across = joints.from_to(std::string("Right") + part, std::string("Left") + part);
    across -= across.dot(up) * up;
    if (across.norm() > 1e-9) return across.normalized();
  }
  return Vec3::Zero();
}

/// The turn about `up` that makes the motion face where the body does, both at rest.
Quat facing(const Joints& body, const Joints& motion, const Vec3& up) {
  const Vec3 to = to_the_left(body, up), from = to_the_left(motion, up);
  if (to.isZero() || from.isZero()) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(std::atan2(from.cross(to).dot(up), from.dot(to)), up));
}

/// Mean length of the legs from hip to ankle; 0 if there are none.
double leg_length(const Joints& joints) {
  double sum = 0;
  int legs = 0;
  for (const std::string side : {"Left", "Right"}) {
    const double length = joints.from_to(side + "UpperLeg", side + "LowerLeg").norm() +
                          joints.from_to(side + "LowerLeg", side + "Foot").norm();
    sum += length;
    legs += length > 0 ? 1 : 0;
  }
  return legs > 0 ? sum / legs : 0;
}

/// Height of the lowest joint of the feet; infinite without feet.
double lowest_foot(const Joints& joints, const Vec3& up) {
  double height = std::numeric_limits<double>::infinity();
  for (const char* joint : {"LeftFoot", "LeftToes", "RightFoot", "RightToes"})
    if (joints.has(joint)) height = std::min(height, up.dot(joints.place(joint)));
  return height;
}

/// For each joint the turn that lays the limb of the body, at rest, along that of the motion at rest. Trunk, head and
/// feet are taken to be upright and flat in both; hands go with their arms.
std::vector<Quat> limb_turns(const Joints& body, const Joints& motion, const Quat& face) {
  std::vector<Quat> turns(joint_names().size(), Quat::Identity());
  const auto turn = [&](const std::string& joint) -> Quat& { return turns[joint_number(joint)]; };
  constexpr std::array<std::array<const char*, 2>, 4> kLimbs{
      {{"UpperArm", "LowerArm"}, {"LowerArm", "Hand"}, {"UpperLeg", "LowerLeg"}, {"LowerLeg", "Foot"}}};
  for (const std::string side : {"Left", "Right"}) {
    for (const auto& [from, to] : kLimbs) {
      const Vec3 ours = body.from_to(side + from, side + to), theirs = face * motion.from_to(side + from, side + to);
      if (ours.norm() > 1e-9 && theirs.norm() > 1e-9) turn(side + from).setFromTwoVectors(ours, theirs);
    }
    turn(side + "Hand") = turn(side + "LowerArm");
  }
  return turns;
}

/// All times at which a joint of the motion has a key, from 0 on.
std::vector<double> key_times(const Clip& clip) {
  std::vector<double> times{0};
  for (const Channel& channel : clip.channels) {
    times.insert(times.end(), channel.rotation.times.begin(), channel.rotation.times.end());
    times.insert(times.end(), channel.position.times.begin(), channel.position.times.end());
  }
  std::sort(times.begin(), times.end());
  std::vector<double> distinct;
  for (const double t : times)
    if (t >= 0 && (distinct.empty() || t - distinct.back() > kSameTime)) distinct.push_back(t);
  return distinct;
}

class Retargeter {
 public:
  Retargeter(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up)
      : body_(body), motion_(motion), clip_(clip), up_(up), at_rest_(rest_pose(body.character)) {
    const Joints ours = joints_at(body_, at_rest_), theirs = joints_at(motion_, rest_pose(motion_.character));
    face_ = facing(ours, theirs, up_);
    const std::vector<Quat> limbs = limb_turns(ours, theirs, face_);
    before_.resize(body_.character.nodes.size());
    after_ = before_;
    joint_of_.assign(body_.character.nodes.size(), -1);
    for (std::size_t j = 0; j < limbs.size(); ++j) {
      const auto joint = static_cast<Index>(j);
      if (!ours.has(joint) || !theirs.has(joint)) continue;
      const auto node = static_cast<std::size_t>(body_.joints[j]);
      joint_of_[node] = joint;
      before_[node] = face_;
      after_[node] = rotation_of(theirs.global(joint)).conjugate() * face_.conjugate() * limbs[j] *
                     rotation_of(ours.global(joint));
    }
    const double ours_leg = leg_length(ours), theirs_leg = leg_length(theirs);
    ratio_ = ours_leg > 0 && theirs_leg > 0 ? ours_leg / theirs_leg : 1;
    hips_ = ours.place("Hips");
    floor_ = lowest_foot(ours, up_);
  }

  Clip run() {
    const std::vector<double> times = key_times(clip_);
    std::vector<Joints> moments;
    double ground = std::numeric_limits<double>::infinity();
    for (const double t : times) {
      moments.push_back(joints_at(motion_, pose_at(motion_.character, clip_, t)));
      ground = std::min(ground, lowest_foot(moments.back(), up_));
    }
    Clip result{clip_.name, clip_.duration, {}, {}};
    for (std::size_t n = 0; n < joint_of_.size(); ++n)
      if (joint_of_[n] >= 0) result.channels.push_back({static_cast<Index>(n), {}, {}, {}});
    for (std::size_t k = 0; k < times.size(); ++k) append(times[k], moments[k], hips_at(moments, k, ground), result);
    return result;
  }

 private:
  /// Where the hips of the body are at a moment.
  Vec3 hips_at(const std::vector<Joints>& moments, std::size_t k, double ground) const {
    const Vec3 place = moments[k].place("Hips"), moved = face_ * (place - moments[0].place("Hips"));
    const bool feet = std::isfinite(ground) && std::isfinite(floor_);
    const double height = feet ? floor_ + ratio_ * (up_.dot(place) - ground) : up_.dot(hips_) + ratio_ * up_.dot(moved);
    const Vec3 level = hips_ + ratio_ * moved;
    return level + (height - up_.dot(level)) * up_;
  }

  /// Appends the key of each joint. Nodes come after their parents, so that each is turned against where its parent is
  /// by then.
  void append(double t, const Joints& moment, const Vec3& hips, Clip& result) const {
    std::vector<Affine> globals;
    std::size_t channel = 0;
    for (std::size_t n = 0; n < joint_of_.size(); ++n) {
      const Index parent_node = body_.character.nodes[n].parent;
      const Affine parent = parent_node < 0 ? Affine::Identity() : globals[parent_node];
      Placement local = at_rest_.nodes[n];
      if (joint_of_[n] >= 0) {
        Channel& to = result.channels[channel++];
        const Quat turned = before_[n] * rotation_of(moment.global(joint_of_[n])) * after_[n];
        local.rotation = (rotation_of(parent).conjugate() * turned).normalized();
        to.rotation.times.push_back(t);
        to.rotation.values.push_back(local.rotation);
        if (joint_of_[n] == joint_number("Hips")) {
          local.position = parent.inverse() * hips;
          to.position.times.push_back(t);
          to.position.values.push_back(local.position);
        }
      }
      globals.push_back(parent * local.to_affine());
    }
  }

  const Rig body_, motion_;
  const Clip& clip_;
  const Vec3 up_;
  const Pose at_rest_;  // of the body
  Quat face_;
  // Of each node of the body: the joint that moves it, or -1; a rotation R of its counterpart becomes before · R ·
  // after.
  std::vector<Index> joint_of_;
  std::vector<Quat> before_, after_;
  double ratio_ = 1;  // of lengths, body to motion
  Vec3 hips_;         // of the body at rest
  double floor_ = 0;  // height of its lowest foot at rest
};

}  // namespace

Clip retarget(const Rig& body, const Rig& motion, const Clip& clip, const Vec3& up) {
  return Retargeter(body, motion, clip, up).run();
}

}  // namespace weft::character
