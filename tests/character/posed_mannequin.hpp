// A mannequin in a pose: hierarchy and linear blend skinning in their simplest form.
#pragma once

#include <algorithm>
#include <vector>

#include "film/character/mannequin.hpp"

namespace weft::character {

inline const Vec3 kUp = Vec3::UnitZ();  ///< up axis of all bodies in these tests

/// Node-to-world transforms at a key of a clip with a rotation for every joint and a position for the hips.
inline std::vector<Affine> joints_at_key(const Character& body, const Clip& clip, std::size_t key) {
  std::vector<Affine> global(body.nodes.size());
  for (std::size_t n = 0; n < global.size(); ++n) {
    const Node& node = body.nodes[n];
    const Vec3 place = n == 0 ? clip.channels[0].position.values[key] : Vec3(node.local.translation());
    const Affine local = Eigen::Translation3d(place) * clip.channels[n].rotation.values[key];
    global[n] = node.parent < 0 ? local : global[node.parent] * local;
  }
  return global;
}

/// Positions of all vertices by linear blend skinning. `global`: node-to-world transforms.
inline std::vector<Vec3> skinned(const Character& body, const std::vector<Affine>& global) {
  std::vector<Vec3> out;
  for (std::size_t v = 0; v < body.mesh.positions.size(); ++v) {
    Vec3 sum = Vec3::Zero();
    for (Index k = body.first_influence[v]; k < body.first_influence[v + 1]; ++k) {
      const Influence& i = body.influences[k];
      const Bone& bone = body.bones[i.bone];
      sum += i.weight * (global[bone.node] * (bone.offset * body.mesh.positions[v]));
    }
    out.push_back(sum);
  }
  return out;
}

/// Weight of a joint at a vertex; 0 if the joint does not move it.
inline double weight_of(const Character& body, std::size_t vertex, Joint joint) {
  for (Index k = body.first_influence[vertex]; k < body.first_influence[vertex + 1]; ++k) {
    const Influence& i = body.influences[k];
    if (i.bone == static_cast<Index>(joint)) return i.weight;
  }
  return 0;
}

}  // namespace weft::character
