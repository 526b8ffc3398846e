// Treats a mesh with texture coordinates as cloth sewn from flat panels: its UV islands are the panels.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/mesh/mesh.hpp"

namespace weft::garment {

/// UV coordinates of the corners of a triangle, v upward; not finite if there are none.
using UvCorners = std::array<Vec2, 3>;

/// Panels in real size, derived from UVs, and how well they fit the mesh.
struct UvRest {
  std::vector<UvCorners> material;  ///< per triangle: (weft, warp) of its corners, counter-clockwise [m]
  Vec2 scale{1, 1};                 ///< length of one UV unit along u and v [m]
  std::string unit;  ///< name of the unit, such as "centimetres"; empty: measured against the mesh, or given
  std::size_t islands = 0;
  std::size_t mirrored = 0;  ///< number of triangles that are mirrored in the UV plane; `material` mirrors them back
  /// Number of triangles without UVs, without an area in the UV plane, a hundred times longer or shorter there than in
  /// the mesh, or too flat there (`flattest` of rest_from_uv). They keep their shape in the mesh.
  std::size_t unusable = 0;
  /// Area of unusable triangles, as a fraction of the mesh's area. Of those too flat, only the area that they lack in
  /// the UVs counts, since small triangles can be too flat in UVs that fit.
  double unusable_area = 0;
  /// Largest relative difference in length between a triangle of the mesh and its panel, over all directions: the
  /// median over the area, and the 95 % quantile.
  double median_stretch = 0, stretch_quantile_95 = 0;
  double alike = 0;  ///< fraction of all edges, weighted by UV length, that are as long as in the mesh within 5 %

  /// Whether `alike` is at least a half and `unusable_area` below 1 %: true for cloth, not for UV charts of other
  /// surfaces.
  bool has_panel_lengths() const;
  /// Text for messages, such as "3 islands, 1 unit = 1 m (metres), 98 % of all edges as long as in the mesh within 5 %;
  /// its triangles are off by 1.2 % (median), 95 % of them by at most 4.3 %".
  std::string describe() const;
};

/// Derives the rest shape from UVs. `uv`: one entry per mesh triangle, or none. If `scale` is not given, it is the unit
/// (metres, centimetres, millimetres or inches) at which most edges are as long as in the mesh; at least a fifth of the
/// edges must be. Otherwise it is the median scale of all edges or, if the fitted scales for u and v differ by more
/// than 5 %, these two. `flattest`: minimum height of a triangle in the UVs, relative to the longest edge of all
/// triangles there. Flatter triangles are unusable if they are higher in the mesh.
UvRest rest_from_uv(const mesh::Mesh& mesh, std::span<const UvCorners> uv, const std::optional<Vec2>& scale,
                    double flattest = 0);

}  // namespace weft::garment
