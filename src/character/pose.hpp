// Where every node of a character is at a moment.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "character/character.hpp"

namespace weft::character {

/// From 0 at u = 0 to 1 at u = 1, level at both ends and beyond them.
inline double ease(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/// Node to parent, in the parts that poses are blended by: the affine map x -> position + rotation · stretch · x.
struct Placement {
  Vec3 position{0, 0, 0};           ///< [m]
  Quat rotation{1, 0, 0, 0};        ///< of unit length
  Mat3 stretch = Mat3::Identity();  ///< scale, mirroring and shear

  Affine to_affine() const;
};

struct Pose {
  std::vector<Placement> nodes;
  std::vector<double> morphs;  ///< weight of each morph target
};

/// Takes a map apart; put together again it is the same up to rounding, whatever shear it holds.
Placement to_placement(const Affine& map);

/// The pose without any clip.
Pose rest_pose(const Character& character);

/// The pose of a clip at time t [s] after its start; before and after the clip that of its ends.
Pose pose_at(const Character& character, const Clip& clip, double t);

/// All times at which a joint has a key, from 0 on; 0 always.
std::vector<double> key_times(const Clip& clip);

/// The uppermost node whose position changes in a clip; -1 if none does.
Index traveling_node(const Clip& clip);

/// From `a` (weight 0) to `b` (weight 1): positions and stretches along straight lines, rotations the shortest way.
Pose blend(const Pose& a, const Pose& b, double weight);

/// The rotation by the smallest angle that takes the direction of `from` to that of `to`; if they are opposite, about
/// one of the axes perpendicular to them. Eigen's own computes that axis by a singular value decomposition, which takes
/// the compiler longer than the rest of this module.
Quat shortest_rotation(const Vec3& from, const Vec3& to);

/// Node to world for every node.
std::vector<Affine> global_transforms(const Character& character, const Pose& pose);

/// Where the vertices are in a pose (linear blend skinning over the blended shapes); parallel over vertices. `out`: as
/// many as the mesh has.
void skin(const Character& character, const Pose& pose, std::span<Vec3> out);

}  // namespace weft::character
