// Makes clearance for cloth between the limbs of a body: if two limbs near cloth are too close or overlap, the skin of
// both moves back toward its bones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/parts.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::character {

/// A plane above which skin must be, in the coordinates of the body.
struct Ground {
  Vec3 up{0, 0, 1};   ///< of unit length
  double height = 0;  ///< up · x of the plane [m]
};

/// The vertex that LimbClearance::move_skin() has moved farthest.
struct LargestDisplacement {
  double distance = 0;  ///< [m]; 0: nothing moved
  Index vertex = -1;
  std::string limb;       ///< limb to which the vertex belongs
  std::string away_from;  ///< the other limb; "ground" if the vertex moved farther up from the ground than back
};

/// Moves skin back along lines from the bones to the skin, to make clearance for cloth. Limbs are upper arms, lower
/// arms with hands, upper legs, lower legs with feet, and the trunk with head and shoulders.
/// - If cloth is near at least one of two limbs, the skin of each limb moves back by at most half of the missing
///   clearance. Skin moves farther only to follow its neighbours, and never by more than half of its line.
/// - Skin that is closer to another limb in the rest pose, as at a common joint, needs only its clearance in the rest
///   pose. Skin that is inside another limb in the rest pose moves only to follow its neighbours.
/// - Skin near cloth is lifted out of the ground, except that of feet.
class LimbClearance {
 public:
  /// Weight of each limb at a vertex.
  using LimbWeights = std::array<float, 9>;

  /// `touched`: per vertex, whether cloth can touch it. `near_cloth`: per vertex, from 0 (no cloth near) to 1 (cloth
  /// lies on it). `clearance`: between limbs [m]; half of it is kept above the ground.
  LimbClearance(const Rig& rig, const VertexMask& touched, std::vector<float> near_cloth, double clearance,
                std::vector<Ground> grounds);

  /// Moves the skin `x`, which must be the result of skin() for the pose. Returns the largest displacement.
  LargestDisplacement move_skin(const Pose& pose, std::span<Vec3> x) const;

 private:
  /// Missing clearance of one vertex in one round of move_skin().
  struct MissingClearance {
    double distance = 0;  // missing clearance [m]
    float near = 0;       // nearness of cloth, 0 to 1: the larger value of the vertex and of the other limb
    Index triangle = -1;  // triangle of the other limb at which the line enters it; -1: none
  };

  void find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                    std::vector<MissingClearance>& missing) const;
  void smooth(std::span<const double> lengths, std::vector<double>& remaining) const;
  void lift_from_ground(std::span<const Vec3> from, std::span<Vec3> x) const;
  LargestDisplacement find_largest_displacement(std::span<const Vec3> before, std::span<const Vec3> unlifted,
                                                std::span<const Vec3> x, std::vector<Index> other) const;

  double clearance_;
  std::vector<Ground> grounds_;
  std::vector<mesh::Triangle> triangles_;  // triangles of the skin that cloth can touch
  std::vector<LimbWeights> limb_weights_, limb_weights_of_triangle_;
  std::vector<float> near_, near_of_triangle_;  // nearness of cloth, 0 to 1
  VertexMask touched_, foot_;
  std::vector<double> missing_at_rest_;      // missing clearance in the rest pose [m]
  std::vector<std::array<Index, 2>> edges_;  // of `triangles_`
  Character bones_;                          // the body; vertices of its mesh are the points where the lines start
};

}  // namespace weft::character
