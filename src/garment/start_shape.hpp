// Where the panels of a garment start.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::garment {

/// Panels with their placed corners, before they are one surface.
struct LaidPanel {
  bool back = false;
  std::vector<mesh::Triangle> triangles;     ///< of joined vertices; counter-clockwise seen from before
  std::vector<std::array<Vec2, 3>> corners;  ///< where the panel alone would put them: across and up [m]
};

/// One place in the plane for each joined vertex, such that the edges keep the vectors they have in their panels as
/// well as they can together (least squares): closing seams and darts spreads smoothly over the panels.
std::vector<Vec2> lay_together(std::span<const LaidPanel> panels, std::size_t vertices);

/// Takes the panels apart in depth: with d the distance in the plane to the nearest seam between front and back, front
/// panels go to −f(d) and back panels to +f(d), f(d) = √(d (2 depth − d)), and f = depth from d = depth on: a pillow
/// with round edges. Then each vertex inside moves between its neighbours a few times. Both halves are graphs over the
/// plane, on either side of it: they meet in the seams alone. Returns (across, depth, up) [m].
std::vector<Vec3> inflate(std::span<const LaidPanel> panels, std::span<const Vec2> plane, double depth);

}  // namespace weft::garment
