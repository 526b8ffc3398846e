// From a surface's positions to what is drawn: vertices with normals, edges sharper than the crease angle kept hard.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::render {

using Triangle = std::array<Index, 3>;

/// Which corners of which triangles meet at each vertex. Corner c belongs to triangle c / 3.
class CornerMap {
 public:
  CornerMap() = default;
  /// Throws Error(internal) where a triangle names a vertex outside [0, vertex_count).
  CornerMap(std::span<const Triangle> triangles, std::size_t vertex_count);

  std::span<const std::int32_t> corners(std::size_t vertex) const {
    return {corners_.data() + first_[vertex], corners_.data() + first_[vertex + 1]};
  }

 private:
  std::vector<std::int32_t> first_{0}, corners_;
};

/// True where every edge is that of two triangles that run along it in opposite ways, so that a surface has an inside.
bool is_closed(std::span<const Triangle> triangles);

/// Twice the area times the unit normal of each triangle [m²]; counter-clockwise seen from the tip. Zero for
/// triangles without area.
std::vector<Vec3> area_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions);

class Holes;

/// One surface as it is drawn: world positions [m] and triangles of them.
struct DrawnMesh {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  const Holes* holes = nullptr;  ///< null: none
  float opacity = 1;             ///< to light
};

/// A mesh in which a vertex on a crease appears once for each normal it has.
struct ShadedMesh {
  std::vector<Index> source;        ///< per drawn vertex: the vertex of the surface it stands for
  std::vector<Vec3> normals;        ///< per drawn vertex, unit length
  std::vector<Triangle> triangles;  ///< of drawn vertices; same order as the surface's
};

/// Each corner averages those triangles round its vertex that its own triangle meets at less than `crease_angle`
/// [degrees, 0 to 180], weighted by area; 180 shares every vertex and tends to the normal of the smooth surface that a
/// fine mesh stands for. Vertices without any area get +z.
ShadedMesh shade(std::span<const Triangle> triangles, const CornerMap& corners, std::span<const Vec3> positions,
                 double crease_angle);

}  // namespace weft::render
