// The volume that a surface encloses, and its derivative with respect to the positions of the particles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::forces {

/// The volume inside a triangle surface. Each opening is closed by triangles from the edges of its border to the mean
/// of the border's particles, because the volume of an open surface would depend on the origin. The volumes of separate
/// surfaces are added, each with its sign.
///
/// V = 1/3 Σ x_i · ∂V/∂x_i. The derivative ∂V/∂x_i = 1/6 Σ x_j × x_k, over the triangles (i, j, k) of the vertex star
/// of i, is a third of the sum of their area vectors. The derivative with respect to a border's mean is divided equally
/// among the border's particles.
class EnclosedVolume {
 public:
  /// `triangles`: manifold, consistently oriented, over particles 0 to start.size() − 1. The sign of the volume is such
  /// that the surface at `start` [m] has a positive volume; if the volume at `start` is zero up to
  /// rounding, the front of the triangles is outside.
  EnclosedVolume(std::span<const mesh::Triangle> triangles, std::span<const Vec3> start);

  /// Returns the volume [m³] at x [m], one position per particle. Writes ∂V/∂x [m²] into
  /// `gradient`, which has the same size as x. The entries of ∂V/∂x sum to zero.
  double evaluate(std::span<const Vec3> x, std::span<Vec3> gradient) const;

  /// Whether this volume [m³] is zero up to rounding, or negative.
  bool is_flat(double volume) const { return volume <= flat_; }

 private:
  std::vector<Index> star_begin_;            // per vertex: its first entry in star_; last: the size of star_
  std::vector<std::array<Index, 2>> star_;   // the two other corners of each triangle of the vertex star
  std::vector<std::vector<Index>> borders_;  // particles of each border; their mean is a further vertex
  double sign_ = 1;                          // −1 if the volume at the start positions would be negative otherwise
  double flat_ = 0;                          // volume up to which the surface counts as flat [m³]
};

}  // namespace weft::forces
