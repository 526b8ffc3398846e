// Poses: the transforms of all nodes of a character, and the weights of its morph targets, at one time.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "film/character/character.hpp"

namespace weft::character {

/// Smooth step from 0 at u = 0 to 1 at u = 1, with zero slope at both ends; constant outside [0, 1].
inline double ease(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/// Transform from a node to its parent, x -> position + rotation · stretch · x, decomposed so that poses can be
/// blended.
struct Placement {
  Vec3 position{0, 0, 0};           ///< [m]
  Quat rotation{1, 0, 0, 0};        ///< of unit length
  Mat3 stretch = Mat3::Identity();  ///< scale, mirroring and shear

  Affine to_affine() const;
};

/// Transforms of all nodes and weights of all morph targets.
struct Pose {
  std::vector<Placement> nodes;
  std::vector<double> morphs;  ///< weight of each morph target
};

/// Decomposes an affine map, exactly except for rounding errors. Shear is part of the stretch.
Placement to_placement(const Affine& map);

/// The pose with Node::local for all nodes, and MorphTarget::weight for all morph targets.
Pose rest_pose(const Character& character);

/// The pose of a clip at time t [s] after its start; for times outside the clip, the pose at its nearer end.
Pose pose_at(const Character& character, const Clip& clip, double t);

/// Two key times of different joints count as one if they differ by at most this [s].
inline constexpr double kSameTime = 1e-6;

/// Distinct times >= 0 of all rotation and position keys of a clip, ascending; always includes 0.
std::vector<double> key_times(const Clip& clip);

/// The nodes whose position changes in a clip, except descendants of other such nodes; in the order of nodes (parents
/// first). Rigs may have several: the hips, and feet that are not descendants of the hips. `also`: a node that counts
/// even if its position does not change; -1: none.
std::vector<Index> traveling_nodes(const Character& character, const Clip& clip, Index also = -1);

/// The node whose path is the travel of the body in a clip: of `traveling`, the result of traveling_nodes(), the node
/// that carries most skin; or the lowest node below it that also changes its position and carries the same skin, such
/// as hips below a root. If none of them carries skin, the first of `traveling`; -1 if there is none.
Index leading_node(const Character& character, const Clip& clip, std::span<const Index> traveling);

/// Interpolates from `a` (weight 0) to `b` (weight 1): positions and stretches linearly, rotations along the shortest
/// arc.
Pose blend(const Pose& a, const Pose& b, double weight);

/// The smallest rotation from the direction of `from` to that of `to`; if they are opposite, about any perpendicular
/// axis. Replaces Quat::FromTwoVectors(), because the singular value decomposition in it takes long to compile.
Quat shortest_rotation(const Vec3& from, const Vec3& to);

/// Angle between two vectors [rad].
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Transforms from node to world, for every node.
std::vector<Affine> global_transforms(const Character& character, const Pose& pose);

/// Transform from the parent of a node to the world; the identity for a root.
Affine parent_transform(const Character& character, const Pose& pose, Index node);

/// Computes the positions of the vertices in a pose: adds the morph targets, then applies linear blend skinning.
/// Parallel over vertices. `out`: one entry per vertex of the mesh.
void skin(const Character& character, const Pose& pose, std::span<Vec3> out);

}  // namespace weft::character
