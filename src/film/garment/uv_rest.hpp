// Derives the rest shape of a mesh from its UVs: each UV island is a flat panel from which the cloth was sewn.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/mesh/mesh.hpp"

namespace weft::garment {

/// UV coordinates of the corners of a triangle, v upward; not finite if the triangle has none.
using UvCorners = std::array<Vec2, 3>;

/// Panels in real size, derived from UVs, and measures of how well they fit the mesh.
struct UvRest {
  std::vector<UvCorners> material;  ///< per triangle: (weft, warp) of its corners, counter-clockwise [m]
  Vec2 scale{1, 1};                 ///< length of one UV unit along u and v [m]
  std::string unit;                 ///< name of the unit, such as "centimetres"; empty: the scale is fitted or given
  std::size_t islands = 0;          ///< number of connected regions of the UVs
  std::size_t mirrored = 0;         ///< number of triangles that are clockwise in the UVs; `material` mirrors them
  /// Number of unusable triangles. A triangle is unusable if it has no UVs or no area in the UVs, if it is a hundred or
  /// more times longer or shorter there than in the mesh in some direction, or if it is too flat there (`flattest` of
  /// rest_from_uv()). Its rest shape is its shape in the mesh.
  std::size_t unusable = 0;
  /// Area of unusable triangles in the mesh, as a fraction of the area of the mesh. If a triangle is only too flat in
  /// the UVs, its area in the mesh minus that in the UVs counts, because small triangles can be too flat even in UVs
  /// that fit.
  double unusable_area = 0;
  /// Median and 95 % quantile of the stretch of triangles, weighted by area. The stretch of a triangle is the largest
  /// relative difference in length between mesh and panel, over all directions. Unusable triangles do not count, except
  /// those that are only too flat.
  double median_stretch = 0, stretch_quantile_95 = 0;
  /// Fraction of edges whose lengths in mesh and panel differ by at most 5 %, weighted by length in the UVs.
  double fitting_edge_fraction = 0;

  /// Whether the UVs are panels from which the cloth was sewn, instead of charts for textures only:
  /// `fitting_edge_fraction` ≥ 0.5 and `unusable_area` < 1 %.
  bool has_panel_lengths() const;
  /// Text for messages, such as "3 islands, 1 unit = 1 m (metres), 98 % of all edges as long as in the mesh within 5 %;
  /// its triangles are off by 1.2 % (median), 95 % of them by at most 4.3 %".
  std::string describe() const;
};

/// Derives the rest shape from UVs. `uv`: one entry per mesh triangle; if it is empty, so is the result. `flattest`:
/// minimum height of a triangle in the panels, relative to the longest edge of all triangles there; a flatter triangle
/// is unusable if it is higher in the mesh. If `scale` is absent, finds it:
/// - The scale is the unit (metres, centimetres, millimetres or inches) that fits most edges. A unit fits an edge if
///   the length of the edge in this unit is that in the mesh within 2 %.
/// - If no unit fits more than a fifth of the edges, fits scales along u and v separately.
/// - If these two differ by at most 5 % or are undetermined, uses the median scale of all edges for both.
UvRest rest_from_uv(const mesh::Mesh& mesh, std::span<const UvCorners> uv, const std::optional<Vec2>& scale,
                    double flattest = 0);

}  // namespace weft::garment
