// Triangles sorted into boxes of even size, to be asked which of them a straight way goes through.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "mesh/topology.hpp"

namespace weft::mesh {

/// Where a way goes through the front of a triangle.
struct Entry {
  double t = 0;         ///< share of the way
  Index triangle = -1;  ///< of those of the grid; -1: nowhere
};

/// The triangles and the positions must outlive it.
class TriangleGrid {
 public:
  /// `cell`: edge of a box [m]; made longer where there would be too many.
  TriangleGrid(std::span<const Triangle> triangles, std::span<const Vec3> x, double cell);

  /// The first triangle with `passes(number of it)` through which the way from `from` to `to` goes in at its front.
  template <class Passes>
  Entry first_entry(const Vec3& from, const Vec3& to, const Passes& passes) const {
    Entry entry{1, -1};
    walk(from, to, [&](std::span<const Index> here, double leaves) {
      for (const Index number : here) {
        const double t = entry_of(triangles_[number], from, to);
        if (t < entry.t && passes(number)) entry = {t, number};
      }
      return entry.triangle >= 0 && entry.t <= leaves;
    });
    return entry;
  }

 private:
  /// Of a triangle that the way goes into at its front, else 2.
  double entry_of(const Triangle& triangle, const Vec3& from, const Vec3& to) const;
  std::span<const Index> in_cell(const std::array<int, 3>& cell) const;

  /// Calls `look(triangles of the box, share of the way at which it is left)` for boxes along the way until that is
  /// true.
  template <class Look>
  void walk(const Vec3& from, const Vec3& to, const Look& look) const;

  std::span<const Triangle> triangles_;
  std::span<const Vec3> x_;
  Vec3 low_{0, 0, 0};
  double cell_ = 1;
  std::array<int, 3> counts_{};  // boxes along each axis
  std::vector<Index> first_;     // of each box in `listed_`, and the number of all
  std::vector<Index> listed_;    // triangles by box
};

template <class Look>
void TriangleGrid::walk(const Vec3& from, const Vec3& to, const Look& look) const {
  std::array<int, 3> at{}, step{};
  Vec3 next, every;  // shares of the way at which it crosses into the next box along each axis
  const Vec3 way = to - from;
  for (int k = 0; k < 3; ++k) {
    const double place = (from[k] - low_[k]) / cell_;
    at[k] = static_cast<int>(std::floor(place));
    step[k] = way[k] > 0 ? 1 : -1;
    const double speed = std::abs(way[k]) / cell_;
    const double left = way[k] > 0 ? at[k] + 1 - place : place - at[k];
    next[k] = speed > 0 ? left / speed : 2;
    every[k] = speed > 0 ? 1 / speed : 2;
  }
  for (;;) {
    int axis = 0;
    const double leaves = next.minCoeff(&axis);
    if (look(in_cell(at), leaves) || leaves >= 1) return;
    at[axis] += step[axis];
    next[axis] += every[axis];
  }
}

}  // namespace weft::mesh
