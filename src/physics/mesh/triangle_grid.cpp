#include "physics/mesh/triangle_grid.hpp"

#include <algorithm>
#include <cmath>

namespace weft::mesh {
namespace {

/// Maximum number of cells; rounding up along each axis can add 3 %.
constexpr double kMaxCells = 1e6;

}  // namespace

TriangleGrid::TriangleGrid(std::span<const Triangle> triangles, std::span<const Vec3> x, double cell)
    : triangles_(triangles), x_(x), cell_(cell) {
  Box3 box;
  for (const Triangle& t : triangles)
    for (const Index v : t) box.extend(x[v]);
  if (triangles.empty()) box.extend(Vec3(Vec3::Zero()));
  low_ = box.min();
  const Vec3 size = box.diagonal();
  cell_ = std::max(cell_, size.maxCoeff() / std::cbrt(kMaxCells));
  std::size_t cells = 1;
  for (int k = 0; k < 3; ++k) cells *= static_cast<std::size_t>(counts_[k] = 1 + static_cast<int>(size[k] / cell_));
  const auto for_each_overlap = [&](const auto& visit) {
    for (std::size_t number = 0; number < triangles.size(); ++number) {
      Box3 around;
      for (const Index v : triangles[number]) around.extend(x[v]);
      std::array<int, 3> from{}, to{};
      for (int k = 0; k < 3; ++k) {
        from[k] = std::clamp(static_cast<int>((around.min()[k] - low_[k]) / cell_), 0, counts_[k] - 1);
        to[k] = std::clamp(static_cast<int>((around.max()[k] - low_[k]) / cell_), 0, counts_[k] - 1);
      }
      for (int i = from[0]; i <= to[0]; ++i)
        for (int j = from[1]; j <= to[1]; ++j)
          for (int k = from[2]; k <= to[2]; ++k)
            visit((static_cast<std::size_t>(i) * counts_[1] + j) * counts_[2] + k, static_cast<Index>(number));
    }
  };
  // Counting sort: count the entries of each cell, sum the counts, then place the triangles.
  first_.assign(cells + 1, 0);
  for_each_overlap([&](std::size_t at, Index) { ++first_[at + 1]; });
  for (std::size_t c = 0; c < cells; ++c) first_[c + 1] += first_[c];
  listed_.resize(first_.back());
  std::vector<Index> place(first_.begin(), first_.end() - 1);
  for_each_overlap([&](std::size_t at, Index number) { listed_[place[at]++] = number; });
}

std::span<const Index> TriangleGrid::in_cell(const std::array<int, 3>& cell) const {
  for (int k = 0; k < 3; ++k)
    if (cell[k] < 0 || cell[k] >= counts_[k]) return {};
  const std::size_t at = (static_cast<std::size_t>(cell[0]) * counts_[1] + cell[1]) * counts_[2] + cell[2];
  return std::span(listed_).subspan(first_[at], first_[at + 1] - first_[at]);
}

// Möller & Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", restricted to crossings from the front.
double TriangleGrid::crossing_of(const Triangle& triangle, const Vec3& from, const Vec3& to) const {
  constexpr double kNowhere = 2;
  const Vec3 &a = x_[triangle[0]], path = to - from;
  const Vec3 ab = x_[triangle[1]] - a, ac = x_[triangle[2]] - a, p = path.cross(ac);
  const double volume = ab.dot(p);  // positive if the path runs against the normal
  if (!(volume > 0)) return kNowhere;
  const Vec3 s = from - a;
  const double u = s.dot(p);
  if (u < 0 || u > volume) return kNowhere;
  const Vec3 q = s.cross(ab);
  const double v = path.dot(q);
  if (v < 0 || u + v > volume) return kNowhere;
  const double t = ac.dot(q) / volume;
  return t >= 0 && t <= 1 ? t : kNowhere;
}

}  // namespace weft::mesh
