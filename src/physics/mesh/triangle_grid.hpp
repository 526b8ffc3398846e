// A uniform grid of cells that list triangles, to find the triangles that a straight path crosses.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// First crossing of a path with the front of a triangle.
struct Entry {
  double t = 0;         ///< fraction of the path up to the crossing; 1 if there is none
  Index triangle = -1;  ///< index into the triangles of the grid; -1: no crossing
};

/// Finds crossings of straight paths with triangles. `triangles` and `x` (vertex positions) must outlive the grid.
class TriangleGrid {
 public:
  /// `cell`: edge length of a cubic cell [m]; enlarged if the longest side of the bounding box has
  /// more than 100 cells.
  TriangleGrid(std::span<const Triangle> triangles, std::span<const Vec3> x, double cell);

  /// Of the triangles that the path from `from` to `to` crosses from their front, finds the first one for which
  /// passes(index) is true. A crossing exactly at `to` does not count.
  template <class Passes>
  Entry find_first_crossing(const Vec3& from, const Vec3& to, const Passes& passes) const {
    Entry entry{1, -1};
    walk(from, to, [&](std::span<const Index> here, double exit_t) {
      for (const Index number : here) {
        const double t = crossing_of(triangles_[number], from, to);
        if (t < entry.t && passes(number)) entry = {t, number};
      }
      return entry.triangle >= 0 && entry.t <= exit_t;
    });
    return entry;
  }

 private:
  /// Fraction of the path up to its crossing with the front of the triangle; 2 if there is none.
  double crossing_of(const Triangle& triangle, const Vec3& from, const Vec3& to) const;
  std::span<const Index> in_cell(const std::array<int, 3>& cell) const;

  /// Calls visit(triangles, exit_t) for each cell along the path, until a call returns true or the path ends.
  /// `triangles`: those of the cell; `exit_t`: fraction of the path up to its exit from the cell.
  template <class Visit>
  void walk(const Vec3& from, const Vec3& to, const Visit& visit) const;

  std::span<const Triangle> triangles_;
  std::span<const Vec3> x_;
  Vec3 low_{0, 0, 0};
  double cell_ = 1;
  std::array<int, 3> counts_{};  // cells along each axis
  std::vector<Index> first_;     // start of each cell in `listed_`, then the total count
  std::vector<Index> listed_;    // triangle indices, cell by cell
};

template <class Visit>
void TriangleGrid::walk(const Vec3& from, const Vec3& to, const Visit& visit) const {
  std::array<int, 3> at{}, step{};
  // Per axis, fractions of the path: `next`, up to the next cell boundary; `stride`, between two boundaries.
  Vec3 next, stride;
  const Vec3 path = to - from;
  for (int k = 0; k < 3; ++k) {
    const double place = (from[k] - low_[k]) / cell_;
    at[k] = static_cast<int>(std::floor(place));
    step[k] = path[k] > 0 ? 1 : -1;
    const double speed = std::abs(path[k]) / cell_;
    const double left = path[k] > 0 ? at[k] + 1 - place : place - at[k];
    next[k] = speed > 0 ? left / speed : 2;
    stride[k] = speed > 0 ? 1 / speed : 2;
  }
  for (;;) {
    int axis = 0;
    const double exit_t = next.minCoeff(&axis);
    if (visit(in_cell(at), exit_t) || exit_t >= 1) return;
    at[axis] += step[axis];
    next[axis] += stride[axis];
  }
}

}  // namespace weft::mesh
