// Search for near pairs with CGAL's AABB tree, for comparison with BroadPhase.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/types.hpp"

namespace weft::bench {

struct CgalCosts {
  double build_ms = 0, query_ms = 0;
  std::size_t pairs = 0;
};

/// Finds all pairs of triangles of which one intersects the bounding box of the other, enlarged by `reach` [m]. The
/// tree cannot be refitted, so it must be rebuilt in each step of a moving sheet.
CgalCosts cgal_self_pairs(std::span<const Vec3> x, std::span<const std::array<Index, 3>> triangles, double reach);

}  // namespace weft::bench
