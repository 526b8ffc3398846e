// Room for cloth between the limbs of a body: where they come closer than that, or go into each other as captured
// motions have them do on other bodies, the skin of both gives way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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

/// Skin gives way along the lines from its bones to where it is: upper and lower arms and legs, feet, and the trunk
/// with the head against each other, by half of what is missing each. Skin that is as close at rest, as at the joint of
/// two limbs, is not asked for more room than it has there. It does not show: skin that is in another limb is not seen.
/// Skin that goes into the ground, but for that of feet, is flattened above it.
class Room {
 public:
  /// How much of a vertex each limb holds.
  using Shares = std::array<float, 11>;

  /// `touched`: for each vertex whether cloth can touch it. `room`: [m]; half of it is left above the ground.
  Room(const Rig& rig, const VertexMask& touched, double room, std::vector<Ground> grounds);

  /// Moves the skin, given as skin() has it in a pose.
  void make(const Pose& pose, std::span<Vec3> x) const;

 private:
  void find_missing(std::span<const Vec3> from, std::span<const Vec3> skin, std::span<const Vec3> x,
                    std::vector<double>& missing) const;
  void smooth(std::vector<double>& shares) const;
  void lift(std::span<const Vec3> from, std::span<Vec3> x) const;

  double room_;
  std::vector<Ground> grounds_;
  std::vector<mesh::Triangle> triangles_;  // that cloth can touch
  std::vector<Shares> shares_, shares_of_triangle_;
  VertexMask touched_, foot_;
  std::vector<double> missing_at_rest_;  // [m]
  std::vector<std::array<Index, 2>> edges_;
  Character bones_;  // its mesh: where the lines of the vertices begin, as bound
};

}  // namespace weft::character
