// Start positions of panels that start flat, in front of and behind the wearer.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::garment {

/// Distance between layers of panels at the start [m]; larger than the contact thickness of any fabric.
inline constexpr double kLayerDistance = 0.01;

/// A panel at its start position, before seams join it to others.
struct LaidPanel {
  bool back = false;                         ///< whether it is behind the wearer; otherwise in front
  int layer = 0;                             ///< Panel::layer
  std::vector<mesh::Triangle> triangles;     ///< by vertices of the garment; counter-clockwise seen from in front
  std::vector<std::array<Vec2, 3>> corners;  ///< per triangle: positions across and up [m]
};

/// Finds one position in the plane for each vertex of the garment. Edges of the mesh keep the vectors that they have in
/// their panels as well as possible (least squares), so that the distortion by closed seams and darts spreads smoothly
/// over the panels.
std::vector<Vec2> lay_together(std::span<const LaidPanel> panels, std::size_t vertices);

/// Separates front and back panels, which makes the shape of a pillow with round edges. Front panels move to the depth
/// −f(d) and back panels to +f(d), where d is the distance in the plane to the nearest seam between front and back:
/// f(d) = √(d (2 depth − d)) for d < depth, else f(d) = depth. Except on these seams, f is larger by kLayerDistance for
/// each layer; on other seams between layers, that of the higher layer. If all panels are on layer 0, some smoothing
/// rounds then move each vertex toward its neighbours, except vertices on these seams and on the rims of openings. They
/// would move layers through each other, since rims stay. Front and back cannot intersect, because depths are ≤ 0 in
/// front and ≥ 0 at the back. Returns (across, depth, up) [m].
std::vector<Vec3> inflate(std::span<const LaidPanel> panels, std::span<const Vec2> plane, double depth);

/// Moves each vertex whose `chosen` is not 0 halfway to the mean position that its neighbours had before the call.
void smooth(const std::vector<std::vector<Index>>& neighbours, const std::vector<char>& chosen, std::span<Vec3> x);

}  // namespace weft::garment
