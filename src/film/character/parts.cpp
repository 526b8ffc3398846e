#include "film/character/parts.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "film/character/joints.hpp"

namespace weft::character {
namespace {

/// A part that consists of several joints. `sides`: joints that exist left and right, without "Left" and "Right".
struct PartGroup {
  std::string name;
  std::vector<std::string> middle, sides;
};

const std::vector<PartGroup> kGroups = {
    {"hands", {}, {"Hand"}},
    {"feet", {}, {"Foot", "Toes"}},
    {"arms", {}, {"UpperArm", "LowerArm", "Hand"}},
    {"legs", {}, {"UpperLeg", "LowerLeg", "Foot", "Toes"}},
    {"head", {"Neck", "Head"}, {}},
    {"torso", {"Hips", "Spine", "Chest"}, {"Shoulder"}},
};

/// The vertices with at least half of their weight on bones whose nodes pass the test.
VertexMask vertices_weighted_by(const Character& character, const std::function<bool(Index node)>& test) {
  const std::size_t vertices = character.mesh.positions.size();
  VertexMask mask(vertices, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    double weight = 0;
    for (Index i = character.first_influence[v]; i < character.first_influence[v + 1]; ++i) {
      const Influence& influence = character.influences[i];
      if (test(character.bones[influence.bone].node)) weight += influence.weight;
    }
    mask[v] = weight >= 0.5;
  }
  return mask;
}

}  // namespace

const std::vector<std::string>& part_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const PartGroup& group : kGroups) names.push_back(group.name);
    names.insert(names.end(), joint_names().begin(), joint_names().end());
    return names;
  }();
  return kNames;
}

std::vector<Index> joints_of_part(const std::string& name) {
  const std::string word = normalise_word(name);
  std::vector<Index> joints;
  for (const PartGroup& group : kGroups) {
    if (group.name != word) continue;
    for (const std::string& joint : group.middle) joints.push_back(joint_number(joint));
    for (const char* side : {"Left", "Right"})
      for (const std::string& joint : group.sides) joints.push_back(joint_number(side + joint));
    return joints;  // for "head", which is also the name of a joint, the group counts
  }
  if (const Index joint = joint_number(name); joint >= 0) joints.push_back(joint);
  return joints;
}

std::vector<Index> joints_of_nodes(const Character& character, std::span<const Index> nodes) {
  std::vector<Index> joint_of(character.nodes.size(), -1);
  for (std::size_t n = 0; n < joint_of.size(); ++n) {
    const auto own = std::ranges::find(nodes, static_cast<Index>(n));
    const Index parent = character.nodes[n].parent;
    if (own != nodes.end()) {
      joint_of[n] = static_cast<Index>(own - nodes.begin());
    } else if (parent >= 0) {
      joint_of[n] = joint_of[parent];
    }
  }
  return joint_of;
}

VertexMask vertices_of(const Character& character, std::span<const Index> nodes, std::span<const Index> joints) {
  const std::vector<Index> joint_of = joints_of_nodes(character, nodes);
  return vertices_weighted_by(character,
                              [&](Index node) { return std::ranges::find(joints, joint_of[node]) != joints.end(); });
}

std::vector<Limb> limbs_of(const Character& character, std::span<const Index> nodes) {
  static const std::vector<std::string> kArm{"UpperArm", "LowerArm", "Hand"},
      kLeg{"UpperLeg", "LowerLeg", "Foot", "Toes"};
  std::vector<Limb> limbs(character.mesh.positions.size(), Limb::trunk);
  const auto mark = [&](Limb limb, const std::string& side, const std::vector<std::string>& names) {
    std::vector<Index> joints;
    for (const std::string& name : names) joints.push_back(joint_number(side + name));
    const VertexMask mask = vertices_of(character, nodes, joints);
    for (std::size_t v = 0; v < limbs.size(); ++v)
      if (mask[v] != 0) limbs[v] = limb;
  };
  mark(Limb::left_arm, "Left", kArm);
  mark(Limb::right_arm, "Right", kArm);
  mark(Limb::left_leg, "Left", kLeg);
  mark(Limb::right_leg, "Right", kLeg);
  return limbs;
}

VertexMask vertices_below(const Character& character, Index node) {
  std::vector<bool> below(character.nodes.size(), false);
  for (std::size_t n = 0; n < below.size(); ++n) {
    const Index parent = character.nodes[n].parent;
    below[n] = static_cast<Index>(n) == node || (parent >= 0 && below[parent]);
  }
  return vertices_weighted_by(character, [&](Index n) { return below[n]; });
}

VertexMask vertices_of_material(const Character& character, Index material) {
  VertexMask mask;
  for (const Index m : character.material_of_vertex) mask.push_back(m == material);
  return mask;
}

void add_followers(Character& character, const Pose& pose, const VertexMask& part, std::span<const Vec3> places) {
  // Factors of the radius of the mean: on the distance from the skin, and on the diagonal of the bounding box of the
  // body (3 cm for a person); the radius is the sum. With a smaller radius, neighbouring points follow different faces
  // of the skin and move apart; with a larger one, a shoulder moves points at the neck.
  constexpr double kRadiusPerDistance = 2, kRadiusPerSize = 0.015;
  std::vector<Vec3> skinned(character.mesh.positions.size());
  skin(character, pose, skinned);
  const std::vector<Affine> globals = global_transforms(character, pose);
  Box3 box;
  for (std::size_t v = 0; v < part.size(); ++v) box.extend(skinned[v]);
  for (const Vec3& place : places) {
    double nearest_sq = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < part.size(); ++v)
      if (part[v] != 0) nearest_sq = std::min(nearest_sq, (skinned[v] - place).squaredNorm());
    const double radius = kRadiusPerDistance * std::sqrt(nearest_sq) + kRadiusPerSize * box.diagonal().norm();
    std::vector<double> weights(character.bones.size(), 0);
    double total = 0;
    for (std::size_t v = 0; v < part.size(); ++v) {
      const double near = 1 - (skinned[v] - place).squaredNorm() / (radius * radius);
      if (part[v] == 0 || near <= 0) continue;
      total += near * near;
      for (Index i = character.first_influence[v]; i < character.first_influence[v + 1]; ++i)
        weights[character.influences[i].bone] += near * near * character.influences[i].weight;
    }
    Affine map;
    map.matrix().setZero();
    for (std::size_t b = 0; b < weights.size(); ++b) {
      if (weights[b] == 0) continue;
      character.influences.push_back({static_cast<Index>(b), weights[b] / total});
      const Bone& bone = character.bones[b];
      map.matrix() += weights[b] / total * (globals[bone.node] * bone.offset).matrix();
    }
    character.first_influence.push_back(static_cast<Index>(character.influences.size()));
    character.mesh.positions.push_back(map.inverse() * place);
    for (MorphTarget& morph : character.morphs) morph.displacements.push_back(Vec3::Zero());
  }
}

bool has_fingers(const Character& character, std::span<const Index> nodes) {
  // Per node: whether it or a node below it influences skin.
  std::vector<bool> influences_skin(character.nodes.size(), false);
  for (const Influence& influence : character.influences) influences_skin[character.bones[influence.bone].node] = true;
  for (std::size_t n = influences_skin.size(); n-- > 0;)
    if (influences_skin[n] && character.nodes[n].parent >= 0) influences_skin[character.nodes[n].parent] = true;
  constexpr int kFewest = 3;
  return std::ranges::any_of(joints_of_part("hands"), [&](Index joint) {
    int chains = 0;
    for (std::size_t n = 0; n < influences_skin.size(); ++n)
      chains += nodes[joint] >= 0 && character.nodes[n].parent == nodes[joint] && influences_skin[n];
    return chains >= kFewest;
  });
}

}  // namespace weft::character
