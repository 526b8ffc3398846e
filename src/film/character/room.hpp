// Clearance for cloth between the limbs of a body: if two limbs near cloth come too close or overlap, the skin of both
// moves back.
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

/// A plane that the body lies on.
struct Ground {
  Vec3 up{0, 0, 1};   ///< of unit length
  double height = 0;  ///< up · x of the plane [m]
};

/// The vertex that Room::make() moved farthest.
struct Moved {
  double distance = 0;  ///< [m]; 0: nothing moved
  Index vertex = -1;
  std::string limb;       ///< limb that the vertex belongs to
  std::string away_from;  ///< the other limb, or "ground" if the vertex was lifted farther than it moved back
};

/// Moves skin along the lines from its bones. Limbs are upper and lower arms, upper and lower legs, and the trunk with
/// the head. The skin of two limbs moves only if cloth is near one of them, and each by at most half of the missing
/// clearance (farther only to follow its neighbours). Skin that is closer at rest, as at the joint of two limbs, keeps
/// its clearance at rest; limbs that cross at rest are not changed. Skin near cloth is lifted out of the ground, except
/// that of feet.
class Room {
 public:
  /// Weight of each limb at a vertex.
  using LimbWeights = std::array<float, 9>;

  /// `touched`: per vertex, whether cloth can touch it. `near_cloth`: per vertex, from 0 (no cloth near) to 1 (cloth
  /// lies on it). `room`: clearance [m]; half of it is kept above the ground.
  Room(const Rig& rig, const VertexMask& touched, std::vector<float> near_cloth, double room,
       std::vector<Ground> grounds);

  /// Moves the skin `x`, which must be the result of skin() for the pose.
  Moved make(const Pose& pose, std::span<Vec3> x) const;

 private:
  /// Missing clearance of one vertex in one round.
  struct Missing {
    double distance = 0;  // missing clearance [m]
    float near = 0;       // proximity to cloth: own or, if larger, that of the other limb, fading with depth
    Index triangle = -1;  // of the other limb; -1: none
  };

  void find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                    std::vector<Missing>& missing) const;
  void smooth(std::span<const double> lengths, std::vector<double>& remaining) const;
  void lift_from_ground(std::span<const Vec3> from, std::span<Vec3> x) const;
  Moved farthest(std::span<const Vec3> before, std::span<const Vec3> unlifted, std::span<const Vec3> x,
                 std::vector<Index> other) const;

  double room_;
  std::vector<Ground> grounds_;
  std::vector<mesh::Triangle> triangles_;  // those that cloth can touch
  std::vector<LimbWeights> limb_weights_, limb_weights_of_triangle_;
  std::vector<float> near_, near_of_triangle_;
  VertexMask touched_, foot_;
  std::vector<double> missing_at_rest_;  // [m]
  std::vector<std::array<Index, 2>> edges_;
  Character bones_;  // its bound mesh contains the points on the bones at which the lines of the vertices start
};

}  // namespace weft::character
