// The volume that a surface encloses, and its derivative by the positions of the particles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::forces {

/// The volume inside a triangle surface. The fan of triangles from the middle of its border (the mean of the border's
/// particles) closes each opening; so the volume does not depend on the origin. If pieces of the surface are separate,
/// their volumes are added.
///
/// V = 1/3 Σ x_i · ∂V/∂x_i and ∂V/∂x_i = 1/6 Σ x_j × x_k over the triangles (i, j, k) of the vertex star of i: a third
/// of the area vectors there.
class EnclosedVolume {
 public:
  /// `triangles`: manifold, oriented alike, of particles 0 to start.size() − 1. The volume at `start` [m] counts as
  /// positive; if it is zero, the triangles' front is outside.
  EnclosedVolume(std::span<const mesh::Triangle> triangles, std::span<const Vec3> start);

  /// Volume [m³] at x [m], one position per particle. Writes ∂V/∂x [m²] of each particle into `gradient`, which has the
  /// same size; the entries sum to zero.
  double evaluate(std::span<const Vec3> x, std::span<Vec3> gradient) const;

  /// Whether a volume is that of a flat surface, but for rounding.
  bool is_flat(double volume) const { return volume <= flat_; }

  std::size_t openings() const { return borders_.size(); }

 private:
  std::vector<Index> star_begin_;            // per vertex, and the end
  std::vector<std::array<Index, 2>> star_;   // the other corners of its triangles
  std::vector<std::vector<Index>> borders_;  // particles of each; its middle is a vertex behind the particles
  double sign_ = 1;
  double flat_ = 0;  // [m³]
};

}  // namespace weft::forces
