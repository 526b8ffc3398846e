// Drawn mesh of a surface: vertices with normals. Normals are discontinuous at edges sharper than the crease angle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::render {

using Triangle = std::array<Index, 3>;

/// Triangle corners around each vertex. Corner c belongs to triangle c / 3.
class CornerMap {
 public:
  CornerMap() = default;
  /// Throws Error(internal) if a triangle names a vertex outside [0, vertex_count).
  CornerMap(std::span<const Triangle> triangles, std::size_t vertex_count);

  std::span<const std::int32_t> corners(std::size_t vertex) const {
    return {corners_.data() + first_[vertex], corners_.data() + first_[vertex + 1]};
  }

 private:
  std::vector<std::int32_t> first_{0}, corners_;
};

/// Whether every edge belongs to two triangles with opposite directions of the edge, so that the surface encloses a
/// volume.
bool is_closed(std::span<const Triangle> triangles);

/// Twice the area times the unit normal of each triangle [m²]; the normal is on the side from which the corners run
/// counter-clockwise. Zero for degenerate triangles.
std::vector<Vec3> area_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions);

class Holes;

/// One surface as it is drawn: world positions [m] and triangles.
struct DrawnMesh {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  const Holes* holes = nullptr;  ///< null: none
  float opacity = 1;             ///< fraction of light that the surface stops
};

/// A mesh in which a vertex on a crease appears once for each of its normals.
struct ShadedMesh {
  std::vector<Index> source;        ///< per drawn vertex: its vertex of the surface
  std::vector<Vec3> normals;        ///< per drawn vertex, unit length
  std::vector<Triangle> triangles;  ///< of drawn vertices; in the surface's order or, if painted, sorted by part
};

/// Computes the drawn mesh. The normal of a corner is the area-weighted mean over those triangles of its vertex star
/// whose normals differ from that of the corner's triangle by less than `crease_angle` [degrees, 0 to 180] plus a
/// margin of 0.37 degrees. At 180, no vertex is split, and under mesh refinement the normals converge to those of the
/// smooth surface. If the mean is zero, as for degenerate triangles, the normal is +z.
ShadedMesh make_shaded_mesh(std::span<const Triangle> triangles, const CornerMap& corners,
                            std::span<const Vec3> positions, double crease_angle);

}  // namespace weft::render
