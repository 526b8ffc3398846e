// Room for cloth between the limbs of a body: where a motion brings two limbs closer together than that, or into each
// other, and cloth is there, the skin of both gives way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "character/anatomy.hpp"
#include "character/parts.hpp"
#include "mesh/topology.hpp"

namespace weft::character {

/// What the body lies on.
struct Ground {
  Vec3 up{0, 0, 1};   ///< of unit length
  double height = 0;  ///< up · x of its surface [m]
};

/// The vertex that Room::make() moved farthest.
struct Moved {
  double distance = 0;  ///< [m]; 0: nothing moved
  Index vertex = -1;
  std::string limb;       ///< that holds the vertex
  std::string away_from;  ///< the limb that came close, or "the ground"
};

/// The skin moves along the lines from its bones to where it is: upper and lower arms and legs, and the trunk with the
/// head against each other, each by at most half of what is missing. Cloth must be near one of both. Skin that is as
/// close at rest, as at the joint of two limbs, is not asked for more room than it has there; limbs that cross at rest
/// are left so. Skin that goes into the ground, but for that of feet, is flattened above it where cloth is near.
class Room {
 public:
  /// How much of a vertex each limb holds.
  using Shares = std::array<float, 9>;

  /// `touched`: for each vertex whether cloth can touch it. `near_cloth`: for each vertex from 0, where no cloth is
  /// near, to 1, where cloth lies on it. `room`: [m]; half of it is left above the ground.
  Room(const Rig& rig, const VertexMask& touched, std::vector<float> near_cloth, double room,
       std::vector<Ground> grounds);

  /// Moves the skin, given as skin() has it in a pose.
  Moved make(const Pose& pose, std::span<Vec3> x) const;

 private:
  /// What a round finds for one vertex.
  struct Missing {
    double distance = 0;  // [m] of what is to be asked
    float near = 0;       // the larger nearness to cloth of both sides
    Index triangle = -1;  // of the other limb
  };

  void find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                    std::vector<Missing>& missing) const;
  void smooth(std::span<const double> lengths, std::vector<double>& shares) const;
  void lift(std::span<const Vec3> from, std::span<Vec3> x) const;
  Moved farthest(std::span<const Vec3> before, std::span<const Vec3> x, std::span<const Index> other) const;

  double room_;
  std::vector<Ground> grounds_;
  std::vector<mesh::Triangle> triangles_;  // that cloth can touch
  std::vector<Shares> shares_, shares_of_triangle_;
  std::vector<float> near_, near_of_triangle_;
  VertexMask touched_, foot_;
  std::vector<double> missing_at_rest_;  // [m]
  std::vector<std::array<Index, 2>> edges_;
  Character bones_;  // its mesh: where the lines of the vertices begin, as bound
};

}  // namespace weft::character
