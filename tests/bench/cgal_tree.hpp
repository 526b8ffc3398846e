// The same query with CGAL's AABB tree.
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

/// All pairs of triangles of which one meets the box of the other enlarged by `reach`. The tree cannot be refitted, so
/// a moving sheet rebuilds it in each step.
CgalCosts cgal_self_pairs(std::span<const Vec3> x, std::span<const std::array<Index, 3>> triangles, double reach);

}  // namespace weft::bench
