// A mesh with texture coordinates as cloth that was sewn from flat panels: its islands are the panels.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace weft::garment {

/// UV coordinates of the corners of a triangle, v upward; not finite where there are none.
using UvCorners = std::array<Vec2, 3>;

/// The panels that UVs are, in their real size, and how well they fit the mesh.
struct UvRest {
  std::vector<UvCorners> material;  ///< of each triangle: weft and warp of its corners, counter-clockwise [m]
  Vec2 scale{1, 1};                 ///< length of a unit along u and v [m]
  std::string unit;                 ///< "centimetres", where it is one; empty: measured against the mesh, or given
  std::size_t islands = 0;
  std::size_t mirrored = 0;  ///< triangles that are turned over in the plane of the UVs, and back here
  /// Triangles without UVs, without an area in them, or a hundred times longer or shorter there: these have the
  /// shape of the mesh.
  std::size_t unusable = 0;
  double unusable_area = 0;  ///< their share of the mesh
  /// By how much triangles of the mesh differ from these in length, in the direction where they do most: in the middle
  /// of all area, and where 95 % of it differ less.
  double median_stretch = 0, most_stretch = 0;
  double alike = 0;  ///< share of all edges that are as long as in the mesh within 5 %

  /// Whether half of all edges are as long as in the mesh: those of cloth are, those of charts of other surfaces are
  /// not.
  bool like_panels() const;
  /// "3 islands, 1 unit = 1 m (metres), 98 % of all edges as long as in the mesh within 5 %; its triangles are off
  /// by 1.2 % in the middle, 95 % of them by at most 4.3 %".
  std::string describe() const;
};

/// Without a `scale` it is that of metres, centimetres, millimetres or inches at which most edges are as long as in the
/// mesh, if a fifth of them are; else the one at which most are, of u and v each where these differ. `uv` has as many
/// entries as the mesh triangles, or none.
/// `flattest`: triangles with less height in the UVs, as a share of the longest edge there, are unusable.
UvRest rest_from_uv(const mesh::Mesh& mesh, std::span<const UvCorners> uv, const std::optional<Vec2>& scale,
                    double flattest = 0);

}  // namespace weft::garment
