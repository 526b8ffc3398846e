// Surface meshes of triangles or quads.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::mesh {

/// Faces of a surface. Quads keep their four corners and are also split into two triangles, which collision, drawing
/// and files all use, so that there is one surface and not three.
struct Topology {
  std::vector<std::array<Index, 4>> quads;      ///< faces as simulated; empty for a triangle mesh
  std::vector<std::array<Index, 3>> triangles;  ///< counter-clockwise from the front; quad q owns triangles 2q, 2q+1
};

struct Mesh {
  Topology topology;
  std::vector<Vec3> positions;  ///< one per vertex [m]
  std::vector<Vec2> uv;         ///< rest coordinates (weft, warp) per vertex [m]; empty where there are none
};

/// Regular grid of nu × nv particles. Particle (i, j) has index i + nu * j, i along weft (u), j along warp (v).
struct Grid {
  int nu = 0, nv = 0;     ///< particles along weft and warp, at least 2
  double lu = 0, lv = 0;  ///< rest spacing along weft and warp [m]
  Index index(int i, int j) const { return static_cast<Index>(i + nu * j); }
  Index size() const { return static_cast<Index>(nu * nv); }
};

}  // namespace weft::mesh
