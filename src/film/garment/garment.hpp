// Sews a pattern into one mesh around the wearer.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "film/garment/pattern.hpp"
#include "film/garment/triangulation.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::garment {

/// A seam in the mesh. Both of its sides share its vertices.
struct SewnSeam {
  std::vector<Index> vertices;
  double length_a = 0, length_b = 0;  ///< of the two edges in the pattern [m]
};

/// A pattern as one mesh, sewn from the start.
///
/// Sheet::rest holds the start: a smooth surface without intersections, but not isometric to the panels. Its
/// coordinates are those of the world for panels around a wearer, else x to the left, y from front to back, z up.
/// Sheet::material holds the rest shape, that of the flat panels. The front of the cloth faces away from the wearer.
struct Garment {
  mesh::Sheet sheet;
  std::vector<Vec2> uv;         ///< per vertex: coordinates in a plane, for drawing the weave [m]; bent panels overlap
  std::vector<Index> panel_of;  ///< index of the panel, per triangle
  std::vector<SewnSeam> seams;  ///< as in the pattern, without closures
  std::map<std::string, std::vector<Index>> edges;  ///< vertices of each edge by "panel.edge", from its start
};

/// Sews a pattern. `spacing`: edge length of the mesh [m]. `where` names the scene entry for messages. `wearer`:
/// required for patterns with panels around parts of the body. Throws Error(scene_invalid) if panels are too small for
/// the spacing, if the seams do not make a surface, or if panels fold over when they are laid together.
Garment sew(const Pattern& pattern, double spacing, const std::string& where, const Wearer* wearer = nullptr);

/// Meshes one flat panel [m]. `segments`: number of segments of each of its edges; `spacing`: edge length of the mesh.
FlatMesh mesh_of(const Panel& panel, const std::vector<int>& segments, double spacing);

}  // namespace weft::garment
