// Start positions of the panels that are not bent around a part.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {

/// A panel with placed corners, before the panels are joined into one surface.
struct LaidPanel {
  bool back = false;
  std::vector<mesh::Triangle> triangles;     ///< of joined vertices; counter-clockwise seen from in front
  std::vector<std::array<Vec2, 3>> corners;  ///< positions of the corners in the panel alone: across and up [m]
};

/// One position in the plane for each joined vertex. The edges keep the vectors that they have in their panels as well
/// as possible (least squares), so that the distortion by closed seams and darts spreads smoothly over the panels.
std::vector<Vec2> lay_together(std::span<const LaidPanel> panels, std::size_t vertices);

/// Separates front and back panels in depth. Front panels move to −f(d) and back panels to +f(d), where d is the
/// distance in the plane to the nearest seam between front and back: f(d) = √(d (2 depth − d)) for d < depth, else f =
/// depth, a pillow with round edges. A few smoothing steps then move each vertex toward its neighbours, except on these
/// seams and on rims of openings. Both halves are graphs over the plane and meet only in the seams. Returns (across,
/// depth, up) [m].
std::vector<Vec3> inflate(std::span<const LaidPanel> panels, std::span<const Vec2> plane, double depth);

}  // namespace weft::garment
