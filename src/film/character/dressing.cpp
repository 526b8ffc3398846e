#include "film/character/dressing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace weft::character {
namespace {

/// Distance of the skin from the bone at the start of growth, as a fraction of the final distance.
constexpr double kInitialGrowth = 0.1;

/// Length of a bone without other bones below it, such as that of the head, relative to the distance from its node to
/// the mean position of its vertices.
constexpr double kTerminalBoneRatio = 1.3;

using Segment = std::array<Vec3, 2>;

Vec3 nearest_on(const Segment& segment, const Vec3& x) {
  const Vec3 along = segment[1] - segment[0];
  const double length_sq = along.squaredNorm();
  if (length_sq <= 0) return segment[0];
  return segment[0] + std::clamp((x - segment[0]).dot(along) / length_sq, 0.0, 1.0) * along;
}

/// Mean of the point nearest to x on each segment, weighted by the inverse fourth power of its distance.
Vec3 blended_point_on(const std::vector<Segment>& segments, const Vec3& x) {
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const Segment& segment : segments) {
    Vec3 place = nearest_on(segment, x);
    const double distance_sq = (x - place).squaredNorm();
    if (distance_sq <= 0) return place;
    const double weight = 1 / (distance_sq * distance_sq);
    sum += weight * place;
    weights += weight;
  }
  return sum / weights;
}

/// Weighted mean position of the vertices of each bone; if a bone has no vertices, the position of its node.
std::vector<Vec3> mean_positions(const Character& character, const std::vector<Vec3>& places,
                                 const std::vector<Vec3>& skin) {
  std::vector<Vec3> middle(character.bones.size(), Vec3::Zero());
  std::vector<double> weights(middle.size(), 0);
  for (std::size_t v = 0; v < skin.size(); ++v)
    for (Index k = character.first_influence[v]; k < character.first_influence[v + 1]; ++k) {
      const Influence& influence = character.influences[k];
      middle[influence.bone] += influence.weight * skin[v];
      weights[influence.bone] += influence.weight;
    }
  for (std::size_t b = 0; b < middle.size(); ++b)
    middle[b] = weights[b] > 0 ? Vec3(middle[b] / weights[b]) : places[character.bones[b].node];
  return middle;
}

/// Line segments of each bone: from its node to the nodes of the next bones below it. If there is no bone below it, the
/// segment extends from its node through the mean position of its vertices. If several bones have the same node, as in
/// files with several meshes, they share the segments to bones below it.
std::vector<std::vector<Segment>> segments_of(const Character& character, const std::vector<Vec3>& places,
                                              const std::vector<Vec3>& skin) {
  std::vector<bool> has_bone(character.nodes.size(), false);
  for (const Bone& bone : character.bones) has_bone[bone.node] = true;
  std::vector<std::vector<Segment>> below(character.nodes.size());
  for (std::size_t n = 0; n < character.nodes.size(); ++n) {
    if (!has_bone[n]) continue;
    Index above = character.nodes[n].parent;
    while (above >= 0 && !has_bone[above]) above = character.nodes[above].parent;
    if (above >= 0 && places[n] != places[above]) below[above].push_back({places[above], places[n]});
  }
  const std::vector<Vec3> middle = mean_positions(character, places, skin);
  std::vector<std::vector<Segment>> segments;
  for (std::size_t b = 0; b < character.bones.size(); ++b) {
    const Index node = character.bones[b].node;
    segments.push_back(below[node]);
    if (const Vec3& at = places[node]; segments[b].empty())
      segments[b].push_back({at, at + kTerminalBoneRatio * (middle[b] - at)});
  }
  return segments;
}

/// Stores which pairs of bones lie on one chain: the node of one bone is the node of the other or a descendant of it.
class BoneChains {
 public:
  explicit BoneChains(const Character& character) : count_(character.bones.size()), on_one_chain_(count_ * count_, 0) {
    for (std::size_t b = 0; b < count_; ++b)
      for (std::size_t c = 0; c < count_; ++c)
        if (is_below(character, character.bones[b].node, character.bones[c].node))
          on_one_chain_[b * count_ + c] = on_one_chain_[c * count_ + b] = 1;
  }

  /// Weight of a vertex on bones that lie on one chain with `bone`, minus its weight on all other bones, such as those
  /// of the other leg; clamped to [0, 1].
  double branch_weight(std::span<const Influence> influences, Index bone) const {
    double branch_weight = 0;
    for (const Influence& i : influences)
      branch_weight += on_one_chain_[static_cast<std::size_t>(bone) * count_ + static_cast<std::size_t>(i.bone)]
                           ? i.weight
                           : -i.weight;
    return std::clamp(branch_weight, 0.0, 1.0);
  }

 private:
  static bool is_below(const Character& character, Index node, Index above) {
    while (node >= 0 && node != above) node = character.nodes[node].parent;
    return node == above;
  }

  std::size_t count_;
  std::vector<std::uint8_t> on_one_chain_;
};

/// Rotates a node and all nodes below it about the node's position, so that `from` points along `to` in the world.
void point_node(const Character& character, Pose& pose, Index node, const Vec3& from, const Vec3& to) {
  const std::vector<Affine> globals = global_transforms(character, pose);
  const Vec3 place = globals[node].translation();
  const Affine turned =
      Eigen::Translation3d(place) * shortest_rotation(from, to) * Eigen::Translation3d(-place) * globals[node];
  const Index parent = character.nodes[node].parent;
  pose.nodes[node] = to_placement(parent < 0 ? turned : globals[parent].inverse() * turned);
}

}  // namespace

Pose raise_arms(const Rig& rig, const Pose& pose, double degrees, const Vec3& up) {
  const Skeleton skeleton(rig);
  const Vec3 across = skeleton.across_shoulders(skeleton.at(pose));
  const Vec3 left = across - across.dot(up) * up;
  Pose raised = pose;
  if (left.norm() <= 0) return raised;
  const double angle = degrees * std::numbers::pi / 180;
  for (const bool right : {false, true}) {
    const Vec3 out = (right ? -1.0 : 1.0) * left.normalized();
    const Vec3 to = std::sin(angle) * out - std::cos(angle) * up;
    for (const Joint joint : {Joint::left_upper_arm, Joint::left_lower_arm}) {
      const Joint part = on_side(joint, right);
      if (!skeleton.has(part)) continue;
      const Vec3 bone = skeleton.bone(skeleton.at(raised), part);
      if (bone.norm() > 0) point_node(rig.character, raised, rig.joints[joint_index(part)], bone, to);
    }
  }
  return raised;
}

std::vector<Vec3> growth_start_positions(const Character& character, const Pose& pose) {
  std::vector<Vec3> skinned(character.mesh.positions.size()), places;
  skin(character, pose, skinned);
  for (const Affine& global : global_transforms(character, pose)) places.emplace_back(global.translation());
  const std::vector<std::vector<Segment>> segments = segments_of(character, places, skinned);
  const BoneChains chains(character);
  std::vector<Vec3> inside(skinned.size(), Vec3::Zero());
  for (std::size_t v = 0; v < inside.size(); ++v) {
    const std::span influences(character.influences.begin() + character.first_influence[v],
                               character.influences.begin() + character.first_influence[v + 1]);
    for (const Influence& influence : influences) {
      const Vec3& joint = places[character.bones[influence.bone].node];
      const double along = chains.branch_weight(influences, influence.bone);
      inside[v] +=
          influence.weight * (joint + along * (blended_point_on(segments[influence.bone], skinned[v]) - joint));
    }
  }
  return inside;
}

double growth_fraction(double t, double duration) {
  return kInitialGrowth + (1 - kInitialGrowth) * ease(t / duration);
}

}  // namespace weft::character
