// Normals as surfaces are drawn: smooth, but not over edges that are sharper than the crease angle.
#pragma once

#include <array>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Which corners of triangles share a normal: all of a vertex, or those on one side of its creases.
struct NormalGroups {
  std::vector<std::array<Index, 3>> of_corner;  ///< per triangle
  std::vector<Index> vertex_of;                 ///< per group
};

/// By the edges as they are at `positions`.
NormalGroups group_normals(const frame::Surface& surface, const std::vector<Vec3>& positions);

/// Of unit length, per group, triangles weighted by area; upward (0, 0, 1) where a group has no area.
std::vector<Vec3> normals_of(const NormalGroups& groups, const frame::Surface& surface,
                             const std::vector<Vec3>& positions);

}  // namespace weft::exporter
