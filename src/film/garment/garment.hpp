// Makes one mesh around the wearer from a sewing pattern.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "film/garment/pattern.hpp"
#include "film/garment/triangulation.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::garment {

/// A sewn seam: the vertices that its two panel edges share, in the order of the edge Seam::a.
struct SewnSeam {
  std::vector<Index> vertices;
  double length_a = 0, length_b = 0;  ///< lengths of the edges Seam::a and Seam::b in the pattern [m]
};

/// A pattern as one mesh. Panels that a seam joins share the vertices of the seam. Sheet::rest contains the start
/// shape: a smooth surface whose lengths differ from those of the panels. If panels start around a wearer, the start
/// shape is in world coordinates; otherwise x points to the wearer's left, y from front to back, z up. Sheet::material
/// contains the flat panels, which are the rest shape after sewing. The front of the cloth faces away from the wearer,
/// except on turned panels (Panel::turned).
struct Garment {
  mesh::Sheet sheet;
  std::vector<Vec2> uv;         ///< per vertex: texture coordinates of the weave [m]; panels overlap in this plane
  std::vector<Index> panel_of;  ///< index of the panel, per triangle
  std::vector<SewnSeam> seams;  ///< in the order of the pattern, without closures
  /// Per zip and per seam that can tear: the pairs of vertices that ties hold together, in the order of the edge
  /// Seam::a.
  std::vector<std::vector<std::array<Index, 2>>> closures;
  std::map<std::string, std::vector<Index>> edges;  ///< by "panel.edge": vertices of this edge, from its start
};

/// Makes the mesh. `spacing`: edge length of the mesh [m]. `where` names the scene entry for messages. `wearer`:
/// required if panels start around parts of the body. Throws Error(scene_invalid) if
/// - a required wearer is missing or lacks the parts,
/// - neither the pattern nor seams determine the position of a bent panel,
/// - the panels are too large or too small for the spacing,
/// - the seams do not make an orientable manifold surface, or
/// - flat panels fold over when their seams are closed.
Garment sew(const Pattern& pattern, double spacing, const std::string& where, const Wearer* wearer = nullptr);

/// Meshes one flat panel. `segments`: number of mesh edges along each panel edge; `spacing`: edge length [m].
FlatMesh mesh_of(const Panel& panel, const std::vector<int>& segments, double spacing);

}  // namespace weft::garment
