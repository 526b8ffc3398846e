#include "film/character/anatomy.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "film/character/structural_joints.hpp"

namespace weft::character {
namespace {

/// The direction of a vector is not reliable if its length is below this [m], or below this fraction of the length of
/// the vector from which it was computed.
constexpr double kNegligibleLength = 1e-9;

/// Minimum mean weight, over all postures, of the directions that determine an axis. If the mean weight is smaller, a
/// guessed direction gets the missing weight. The weight of a hinge is the squared sine of its bend; an elbow that is
/// always bent by 13° reaches the minimum.
constexpr double kMinDeterminedWeight = 0.05;

/// The weight of a posture decreases with its angle from upright. Widths of the Gaussians (see falloff) for the whole
/// trunk, and for each of its bones [rad]. The trunk leans by 2 to 5° in walking, by more than 15° in stooping.
constexpr double kStandingLean = 5 * kDegree, kStandingBoneLean = 20 * kDegree;

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > kNegligibleLength ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Gaussian weight: 1 at angle 0, 1/e at `width`.
double falloff(double angle, double width) {
  return std::exp(-(angle / width) * (angle / width));
}

/// The first node below `node` whose name contains the word `word` in any case; -1 if there is none.
Index find_below(const Character& character, Index node, std::string_view word) {
  std::vector<char> below(character.nodes.size(), 0);
  below[node] = 1;
  for (std::size_t n = static_cast<std::size_t>(node) + 1; n < below.size(); ++n) {
    const Node& candidate = character.nodes[n];
    if (candidate.parent < 0 || below[candidate.parent] == 0) continue;
    below[n] = 1;
    std::string lower;
    for (const char c : candidate.name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower.find(word) != std::string::npos) return static_cast<Index>(n);
  }
  return -1;
}

/// Finds the axes of the body parts relative to the axes of the joints; see find_anatomy.
class AnatomyFinder {
 public:
  AnatomyFinder(const Skeleton& skeleton, std::span<const Posture> postures, std::span<const Flat> flat, const Vec3& up)
      : skeleton_(skeleton), postures_(postures), flat_(flat), up_(up) {
    own_.fill(Quat::Identity());
    // `level_` replaces the vector to the left of the body if hip and shoulder joints are missing. It depends only on
    // `up`, so that two skeletons get the same vector.
    level_ = up.unitOrthogonal();
  }

  std::array<Quat, kJointCount> find() {
    for (const Joint joint : {Joint::hips, Joint::spine, Joint::chest, Joint::neck, Joint::head})
      if (skeleton_.has(joint)) find_trunk_axes(joint);
    for (const bool right : {false, true}) {
      const Joint chest = trunk_joint();
      if (const Joint shoulder = on_side(Joint::left_shoulder, right); skeleton_.has(shoulder))
        copy_axes(shoulder, chest);
      find_limb_axes(on_side(Joint::left_upper_arm, right), on_side(Joint::left_lower_arm, right), chest, right);
      find_hand_axes(on_side(Joint::left_hand, right), on_side(Joint::left_lower_arm, right), right);
      find_limb_axes(on_side(Joint::left_upper_leg, right), on_side(Joint::left_lower_leg, right), Joint::hips, right);
      find_foot_axes(right);
    }
    return own_;
  }

 private:
  Vec3 axis(const Posture& posture, Joint joint, const Vec3& of) const {
    return posture.rotations[joint_index(joint)] * (own_[joint_index(joint)] * of);
  }

  /// Sum of a world direction over all postures, in the axes of the joint.
  template <class Direction>
  Vec3 sum(Joint joint, const Direction& direction) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < postures_.size(); ++k)
      sum += postures_[k].rotations[joint_index(joint)].conjugate() * Vec3(direction(postures_[k], k));
    return sum;
  }

  /// Weighted sum of the directions `shown`, which the postures determine. If their mean weight is below
  /// kMinDeterminedWeight, the directions `guess` get the missing weight.
  template <class Weight, class Shown, class Guess>
  Vec3 sum(Joint joint, const Weight& weight, const Shown& shown, const Guess& guess) const {
    double weight_sum = 0;
    for (std::size_t k = 0; k < postures_.size(); ++k) weight_sum += weight(postures_[k], k);
    const double missing_weight =
        std::max(0.0, kMinDeterminedWeight - weight_sum / static_cast<double>(postures_.size()));
    return sum(joint, [&](const Posture& p, std::size_t k) {
      Vec3 sum = weight(p, k) * shown(p, k);
      if (missing_weight > 0) sum += missing_weight * guess(p, k);
      return sum;
    });
  }

  /// The axis `of` of a body part in the world, as a function of the posture.
  auto axis_of(Joint joint, const Vec3& of) const {
    return [this, joint, of](const Posture& p, std::size_t) { return axis(p, joint, of); };
  }

  auto upright() const {
    return [this](const Posture&, std::size_t) { return up_; };
  }

  Vec3 along(const Posture& posture, Joint joint) const { return unit(skeleton_.bone(posture, joint)); }

  /// The chest; without a chest, the spine; without both, the hips.
  Joint trunk_joint() const {
    for (const Joint joint : {Joint::chest, Joint::spine})
      if (skeleton_.has(joint)) return joint;
    return Joint::hips;
  }

  /// Gives a joint the axes of another joint, averaged over all postures.
  void copy_axes(Joint joint, Joint from) {
    own_[joint_index(joint)] =
        axes_along(sum(joint, axis_of(from, Vec3::UnitZ())), sum(joint, axis_of(from, Vec3::UnitX())));
  }

  /// Gives a joint the z axis along its mean bone, and the x axis as close as possible to `across` (in the axes of the
  /// joint). If the mean bone is zero, the joint gets the axes of `parent`.
  void align_with_bone(Joint joint, Joint parent, const Vec3& across) {
    const Vec3 z = sum(joint, [&](const Posture& p, std::size_t) { return along(p, joint); });
    if (unit(z).isZero()) return copy_axes(joint, parent);
    own_[joint_index(joint)] = axes_along(z, across);
  }

  void find_trunk_axes(Joint joint) {
    const auto bone = [&](const Posture& p, std::size_t) {
      const Joint below = skeleton_.has(Joint::neck) ? Joint::neck : trunk_joint();
      if (joint == Joint::head) return unit(p.places[joint_index(joint)] - p.places[joint_index(below)]);
      // Some rigs have control nodes above the joint that they move. The bone of such a node points down. Replaces it
      // by the direction of the trunk.
      const Vec3 up_the_bone = along(p, joint), up_the_trunk = unit(skeleton_.trunk(p));
      return up_the_bone.dot(up_the_trunk) < 0 ? up_the_trunk : up_the_bone;
    };
    const auto standing = [&](const Posture& p, std::size_t k) {
      const Vec3 along = bone(p, k);
      return falloff(angle_between(skeleton_.trunk(p), up_), kStandingLean) *
             (along.isZero() ? 1 : falloff(angle_between(along, up_), kStandingBoneLean));
    };
    const Vec3 z = sum(joint, standing, upright(), bone);
    const Vec3 x = sum(joint, [&](const Posture& p, std::size_t) {
      const Vec3 hips = unit(skeleton_.across_hips(p)), shoulders = unit(skeleton_.across_shoulders(p));
      if (hips.isZero() && shoulders.isZero()) return level_;
      if (joint == Joint::hips && !hips.isZero()) return Vec3(hips);
      return shoulders.isZero() || joint == Joint::spine ? Vec3(hips + shoulders) : shoulders;
    });
    // The x axis of the hips has exactly the direction of the line through the hip joints, because this line determines
    // the rotation of the hips best. For other joints, or if z is nearly parallel to the line, the z axis is exact.
    const Vec3 line = unit(x), beside = z - z.dot(line) * line;
    own_[joint_index(joint)] = axes_along(joint == Joint::hips && beside.norm() > 0.1 * z.norm() ? beside : z, x);
  }

  void find_limb_axes(Joint upper, Joint lower, Joint trunk, bool right) {
    if (!skeleton_.has(upper)) return;
    const bool arm = joint_index(upper) < joint_index(on_side(Joint::left_upper_leg, right));
    // Guess of the hinge axis: arms that point to the side bend forward, legs that hang straight down bend backward.
    // For other directions of the bone, the axis rotates with the bone along the shortest arc, and the weight of the
    // guess decreases with the angle.
    const auto guess = [&](const Posture& p, std::size_t) {
      const Vec3 left = axis(p, trunk, Vec3::UnitX()), back = axis(p, trunk, Vec3::UnitY());
      const Vec3 from = arm ? Vec3(right ? -left : left) : Vec3(-axis(p, trunk, Vec3::UnitZ()));
      const Vec3 hinge = from.cross(arm ? Vec3(-back) : back), to = along(p, upper);
      return Vec3((1 + from.dot(to)) / 2 * (shortest_rotation(from, to) * hinge));
    };
    const auto bend = [&](const Posture& p, std::size_t) { return unit(along(p, upper).cross(along(p, lower))); };
    const auto bent = [&](const Posture& p, std::size_t) {
      return skeleton_.has(lower) ? along(p, upper).cross(along(p, lower)).squaredNorm() : 0;
    };
    align_with_bone(upper, trunk, sum(upper, bent, bend, guess));
    if (!skeleton_.has(lower)) return;
    const auto hinge = [&](const Posture& p, std::size_t) {
      return Vec3(shortest_rotation(along(p, upper), along(p, lower)) * axis(p, upper, Vec3::UnitX()));
    };
    align_with_bone(lower, upper, sum(lower, bent, bend, hinge));
  }

  void find_hand_axes(Joint hand, Joint lower_arm, bool right) {
    if (!skeleton_.has(hand)) return;
    if (!skeleton_.has(lower_arm)) return copy_axes(hand, trunk_joint());
    align_with_bone(hand, lower_arm, sum(hand, [&](const Posture& p, std::size_t) {
                      const Vec3 palm = p.knuckles[right].cross(skeleton_.bone(p, hand));
                      return palm.isZero() ? axis(p, lower_arm, Vec3::UnitX()) : unit(palm);
                    }));
  }

  void find_foot_axes(bool right) {
    const Joint shin = on_side(Joint::left_lower_leg, right), foot = on_side(Joint::left_foot, right),
                toes = on_side(Joint::left_toes, right);
    if (!skeleton_.has(foot) || !skeleton_.has(shin)) return;
    const auto flat = [&](const Posture&, std::size_t k) { return flat_[k][right]; };
    const auto forward = [&](const Posture& p, std::size_t) {
      return skeleton_.has(toes) ? along(p, foot)
                                 : Vec3(axis(p, shin, Vec3::UnitZ()).cross(axis(p, shin, Vec3::UnitX())));
    };
    // Guess: the foot is at a right angle to the shin, and the toes are straight.
    own_[joint_index(foot)] =
        axes_along(sum(foot, flat, upright(), axis_of(shin, -Vec3::UnitZ())), sum(foot, flat, forward, forward));
    if (!skeleton_.has(toes)) return;
    const auto of_foot = axis_of(foot, Vec3::UnitX());
    own_[joint_index(toes)] =
        axes_along(sum(toes, flat, upright(), axis_of(foot, Vec3::UnitZ())), sum(toes, flat, of_foot, of_foot));
  }

  const Skeleton& skeleton_;
  std::span<const Posture> postures_;
  std::span<const Flat> flat_;
  Vec3 up_, level_;
  std::array<Quat, kJointCount> own_;  // result: axes of the body parts, in the axes of the joints
};

}  // namespace

Quat axes_along(const Vec3& z, const Vec3& x) {
  const Vec3 first = z.norm() > kNegligibleLength ? Vec3(z.normalized()) : Vec3(Vec3::UnitZ());
  Vec3 second = x - x.dot(first) * first;
  if (!(second.norm() > kNegligibleLength * std::max(1.0, x.norm()))) second = first.unitOrthogonal();
  second.normalize();
  Mat3 axes;
  axes << second, first.cross(second), first;
  return Quat(axes).normalized();
}

Skeleton::Skeleton(const Rig& rig) : rig_(rig) {
  for (std::size_t j = 0; j < kJointCount; ++j)
    for (std::size_t n = 0; n < rig.character.nodes.size(); ++n)
      if (rig.joints[j] >= 0 && rig.character.nodes[n].parent == rig.joints[j])
        children_[j].push_back(static_cast<Index>(n));
  for (const bool right : {false, true}) {
    fingers_[right] = {-1, -1};
    const Index hand = rig.joints[joint_index(on_side(Joint::left_hand, right))];
    if (hand < 0) continue;
    Index little = find_below(rig.character, hand, "pinky");
    for (const char* other : {"little", "pinkie", "ring", "finger4", "finger3"})
      if (little < 0) little = find_below(rig.character, hand, other);
    Index index = find_below(rig.character, hand, "index");
    if (index < 0) index = find_below(rig.character, hand, "finger1");
    fingers_[right] = index >= 0 && little >= 0 ? std::array{index, little} : find_knuckles(rig.character, hand);
  }
}

Posture Skeleton::at(const Pose& pose) const {
  const std::vector<Affine> globals = global_transforms(rig_.character, pose);
  Posture posture;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    posture.places[j].setZero();
    posture.ends[j].setZero();
    posture.rotations[j].setIdentity();
    if (rig_.joints[j] < 0) continue;
    const Affine& global = globals[rig_.joints[j]];
    posture.places[j] = global.translation();
    posture.rotations[j] = to_placement(global).rotation;
    for (const Index child : children_[j]) posture.ends[j] += globals[child].translation();
    posture.ends[j] =
        children_[j].empty() ? posture.places[j] : Vec3(posture.ends[j] / static_cast<double>(children_[j].size()));
  }
  for (std::size_t side = 0; side < 2; ++side)
    posture.knuckles[side] =
        fingers_[side][0] < 0
            ? Vec3(Vec3::Zero())
            : Vec3(globals[fingers_[side][1]].translation() - globals[fingers_[side][0]].translation());
  return posture;
}

Vec3 Skeleton::bone(const Posture& posture, Joint joint) const {
  const std::size_t from = joint_index(joint);
  std::size_t last = from;  // last joint of the limb or trunk
  if (joint <= Joint::head) {
    last = joint_index(Joint::head);
  } else {
    const std::size_t in_side = (from - joint_index(Joint::left_shoulder)) % kSideJointCount;
    const std::size_t end = in_side <= joint_index(Joint::left_hand) - joint_index(Joint::left_shoulder)
                                ? joint_index(Joint::left_hand)
                                : joint_index(Joint::left_toes);
    last = from - in_side + end - joint_index(Joint::left_shoulder);
  }
  for (std::size_t to = from + 1; to <= last; ++to)
    if (has(static_cast<Joint>(to))) return posture.places[to] - posture.places[from];
  return posture.ends[from] - posture.places[from];
}

Vec3 Skeleton::across(const Posture& posture, Joint left) const {
  const Joint right = on_side(left, true);
  return has(left) && has(right) ? Vec3(posture.places[joint_index(left)] - posture.places[joint_index(right)])
                                 : Vec3(Vec3::Zero());
}

Vec3 Skeleton::across_hips(const Posture& posture) const {
  return across(posture, Joint::left_upper_leg);
}

Vec3 Skeleton::across_shoulders(const Posture& posture) const {
  const Vec3 arms = across(posture, Joint::left_upper_arm);
  return arms.isZero() ? across(posture, Joint::left_shoulder) : arms;
}

Vec3 Skeleton::middle_of_hips(const Posture& posture) const {
  if (!has(Joint::left_upper_leg) || !has(Joint::right_upper_leg)) return posture.places[joint_index(Joint::hips)];
  return (posture.places[joint_index(Joint::left_upper_leg)] + posture.places[joint_index(Joint::right_upper_leg)]) / 2;
}

Vec3 Skeleton::trunk(const Posture& posture) const {
  const Vec3 from = middle_of_hips(posture);
  if (has(Joint::left_upper_arm) && has(Joint::right_upper_arm))
    return (posture.places[joint_index(Joint::left_upper_arm)] + posture.places[joint_index(Joint::right_upper_arm)]) /
               2 -
           from;
  for (const Joint top : {Joint::neck, Joint::head, Joint::chest, Joint::spine})
    if (has(top)) return posture.places[joint_index(top)] - from;
  return bone(posture, Joint::hips);
}

double Skeleton::lowest_height(const Posture& posture, std::span<const Joint> joints, const Vec3& up) const {
  double height = std::numeric_limits<double>::infinity();
  for (const Joint joint : joints)
    if (has(joint)) height = std::min(height, up.dot(posture.places[joint_index(joint)]));
  return height;
}

double Skeleton::leg_length(const Posture& posture) const {
  double sum = 0;
  int legs = 0;
  for (const bool right : {false, true}) {
    const Joint upper = on_side(Joint::left_upper_leg, right), lower = on_side(Joint::left_lower_leg, right);
    if (!has(upper) || !has(lower) || !has(on_side(Joint::left_foot, right))) continue;
    sum += bone(posture, upper).norm() + bone(posture, lower).norm();
    ++legs;
  }
  return legs > 0 ? sum / legs : 0;
}

double Skeleton::arm_length(const Posture& posture) const {
  double sum = 0;
  for (const bool right : {false, true}) {
    const Joint upper = on_side(Joint::left_upper_arm, right), lower = on_side(Joint::left_lower_arm, right);
    if (!has(upper) || !has(lower) || !has(on_side(Joint::left_hand, right))) return 0;
    sum += bone(posture, upper).norm() + bone(posture, lower).norm();
  }
  return sum / 2;
}

double size_ratio(const Skeleton& body, const Posture& rest, const Skeleton& motion, const Posture& first) {
  double ours = body.leg_length(rest), theirs = motion.leg_length(first);
  for (const Joint top : {Joint::neck, Joint::head, Joint::chest, Joint::spine}) {
    if (ours > 0 && theirs > 0) break;
    if (!body.has(top) || !motion.has(top)) continue;
    const auto above_hips = [top](const Posture& at) {
      return (at.places[joint_index(top)] - at.places[joint_index(Joint::hips)]).norm();
    };
    ours = above_hips(rest), theirs = above_hips(first);
  }
  return ours > 0 && theirs > 0 ? ours / theirs : 1;
}

std::array<Quat, kJointCount> find_anatomy(const Skeleton& skeleton, std::span<const Posture> postures,
                                           std::span<const Flat> flat, const Vec3& up) {
  return AnatomyFinder(skeleton, postures, flat, up).find();
}

}  // namespace weft::character
