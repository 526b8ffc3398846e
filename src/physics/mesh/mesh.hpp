// Surface meshes of triangles or quads.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/grading.hpp"
#include "core/types.hpp"

namespace weft::mesh {

/// Faces of a surface. Each quad is also stored as two triangles. Collision and drawing both use the triangles, so that
/// cloth collides where it is drawn.
struct Topology {
  std::vector<std::array<Index, 4>> quads;      ///< empty for a triangle mesh
  std::vector<std::array<Index, 3>> triangles;  ///< counter-clockwise from the front; quad q owns triangles 2q, 2q+1
};

struct Mesh {
  Topology topology;
  std::vector<Vec3> positions;  ///< one per vertex [m]
  std::vector<Vec2> uv;         ///< rest coordinates (weft, warp) per vertex [m]; empty if the mesh has none
};

/// Grid of nu × nv particles: columns i along weft (u), rows j along warp (v). Particle (i, j) has index i + nu * j.
struct Grid {
  int nu = 0, nv = 0;                         ///< particle counts, at least 2 (for a rope: nv = 1)
  double lu = 0, lv = 0;                      ///< mean rest spacing along weft and warp [m]
  double weft_grading = 1, warp_grading = 1;  ///< ratio of the last to the first spacing; see graded_fraction()
  Index index(int i, int j) const { return static_cast<Index>(i + nu * j); }
  Index size() const { return static_cast<Index>(nu * nv); }

  /// Rest coordinates of column i and row j, from 0 [m].
  double u(int i) const { return spacings_before(i, nu, weft_grading) * lu; }
  double v(int j) const { return spacings_before(j, nv, warp_grading) * lv; }
  /// The same coordinates, measured from the middle of the sheet [m].
  double x(int i) const { return (spacings_before(i, nu, weft_grading) - 0.5 * (nu - 1)) * lu; }
  double y(int j) const { return (spacings_before(j, nv, warp_grading) - 0.5 * (nv - 1)) * lv; }
  /// Rest spacing between columns i and i + 1, or between rows j and j + 1 [m].
  double du(int i) const { return spacing(i, nu, lu, weft_grading); }
  double dv(int j) const { return spacing(j, nv, lv, warp_grading); }
  /// Width of the strip of the sheet that belongs to a column or row: half of the spacing on each of its sides [m].
  double width_u(int i) const { return width(i, nu, lu, weft_grading); }
  double width_v(int j) const { return width(j, nv, lv, warp_grading); }
  /// Smallest of all spacings [m].
  double min_spacing() const { return std::min({du(0), du(nu - 2), dv(0), dv(nv - 2)}); }

 private:
  // Distance of column or row i from the first one, in units of the mean spacing.
  static double spacings_before(int i, int count, double grading) {
    return grading == 1 ? i : graded_fraction(i, count, grading) * (count - 1);
  }
  static double spacing(int i, int count, double mean, double grading) {
    return grading == 1 ? mean : (spacings_before(i + 1, count, grading) - spacings_before(i, count, grading)) * mean;
  }
  static double width(int i, int count, double mean, double grading) {
    const double before = i > 0 ? spacing(i - 1, count, mean, grading) : 0;
    const double after = i + 1 < count ? spacing(i, count, mean, grading) : 0;
    return 0.5 * (before + after);
  }
};

}  // namespace weft::mesh
