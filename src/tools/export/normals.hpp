// Normals of drawn surfaces: smooth, except across edges that are sharper than the crease angle.
#pragma once

#include <array>
#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::exporter {

/// Groups of triangle corners that share a normal: all corners at a vertex, or all between two creases at the vertex.
struct NormalGroups {
  std::vector<std::array<Index, 3>> of_corner;  ///< group, per triangle
  std::vector<Index> vertex_of;                 ///< vertex, per group
};

/// Groups the corners. An edge is a crease if, at `positions`, the normals of its two triangles
/// differ by more than Surface::crease_angle.
NormalGroups group_normals(const frame::Surface& surface, const std::vector<Vec3>& positions);

/// Unit normals per group, weighted by triangle area; (0, 0, 1) if a group has no area.
std::vector<Vec3> normals_of(const NormalGroups& groups, const frame::Surface& surface,
                             const std::vector<Vec3>& positions);

}  // namespace weft::exporter
