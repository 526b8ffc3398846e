// From a sewing pattern to one mesh around the wearer.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "garment/pattern.hpp"
#include "garment/triangulation.hpp"
#include "mesh/sheet.hpp"

namespace weft::garment {

/// A seam in the mesh: the same vertices for both of its sides.
struct SewnSeam {
  std::vector<Index> vertices;
  double length_a = 0, length_b = 0;  ///< of the two edges in the pattern [m]
};

/// A pattern as one mesh that is sewn from the start.
///
/// Where the panels start is a smooth surface without intersections, and not at all isometric: Sheet::rest holds it, in
/// the wearer's coordinates, x to its left, y from front to back, z up. The shape at rest,
/// Sheet::material, is that of the flat panels. The front of the cloth faces away from the wearer.
struct Garment {
  mesh::Sheet sheet;
  std::vector<Vec2> uv;         ///< per vertex: the panels laid together in one plane, for drawing the weave [m]
  std::vector<Index> panel_of;  ///< per triangle
  std::vector<SewnSeam> seams;  ///< as in the pattern, without closures
  std::map<std::string, std::vector<Index>> edges;  ///< by "panel.edge": its vertices, from its start
};

/// `spacing` [m]: length of the edges of the mesh. `where` names what asks for it. Throws Error(scene_invalid) where
/// panels are too small for the spacing, seams make what is no surface, or panels fold over when they are laid
/// together. `wearer`: of patterns that wrap.
Garment sew(const Pattern& pattern, double spacing, const std::string& where, const Wearer* wearer = nullptr);

/// One panel, flat [m]; `segments` of each of its edges.
FlatMesh mesh_of(const Panel& panel, const std::vector<int>& segments, double spacing);

}  // namespace weft::garment
