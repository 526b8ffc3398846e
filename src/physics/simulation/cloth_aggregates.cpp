// ClothSystem::build_aggregates(): groups of particles for the preconditioner, level by level.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/numerics.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/simulation/cloth_system.hpp"

namespace weft::simulation {
namespace {

/// Indices of one box of a lattice that divides the rest shape: along normal, warp and weft of a
/// grid, or along z, y and x for triangles. build_aggregates() makes aggregates from such boxes.
using Box = std::array<int, 3>;
struct Lattice {
  std::vector<Box> boxes;       // of each particle, or of each box of the finer lattice
  std::array<double, 3> sides;  // of a box, along the same axes [m]
};

// The finest lattice. A grid has one box per particle. A cloth of triangles has cubes whose side is the mean particle
// distance.
Lattice lattice_of(const model::Cloth& cloth) {
  Lattice lattice;
  const mesh::Grid& grid = cloth.grid;
  lattice.sides = {grid.lu, grid.lv, grid.lu};
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) lattice.boxes.push_back({0, j, i});
  if (cloth.sheet.triangles.empty()) return lattice;
  const std::vector<Vec3>& rest = cloth.sheet.rest;
  const Vec3 corner = mesh::bounding_box(rest).min();
  const double side = std::sqrt(mesh::surface_area(cloth.sheet.triangles, rest) / static_cast<double>(rest.size()));
  lattice.sides.fill(side);
  for (const Vec3& x : rest) {
    const Vec3 place = (x - corner) / side;
    lattice.boxes.push_back({static_cast<int>(place.z()), static_cast<int>(place.y()), static_cast<int>(place.x())});
  }
  return lattice;
}

// Doubles each side of the boxes that is at most √2 times the shortest one (of axes with several boxes), so that sides
// become more equal. Cloth is stiffest between particles that are close together, so these are
// merged first. Halves the indices of boxes along at least one axis with several boxes. Of a grid, two axes have
// several; the boxes of triangles are cubes, and all axes are halved.
void coarsen(Lattice& lattice) {
  Box last{0, 0, 0};
  for (const Box& box : lattice.boxes)
    for (std::size_t axis = 0; axis < 3; ++axis) last[axis] = std::max(last[axis], box[axis]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (last[axis] > 0) least = std::min(least, lattice.sides[axis]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lattice.sides[axis] > std::numbers::sqrt2 * least) continue;
    lattice.sides[axis] *= 2;
    for (Box& box : lattice.boxes) box[axis] /= 2;
  }
}

}  // namespace

// Builds the aggregates of the preconditioner. Each level merges the boxes of the next finer one (coarsen()). The last
// level has at most `numerics.linear.coarsest_aggregates` boxes, or one per cloth if there are more cloths. Each frame
// particle is an aggregate of its own at all levels.
void ClothSystem::build_aggregates(const model::Model& model) {
  static_assert(std::size_t{2 * std::numeric_limits<int>::digits} <= solver::kMaxAggregateLevels,
                "coarsen() halves indices of type int to 0 along at most two axes that are not halved together");
  std::vector<Lattice> lattices;
  for (const model::Cloth& cloth : model.cloths) lattices.push_back(lattice_of(cloth));
  bool is_coarse = false;
  do {
    solver::Aggregates aggregates;
    for (Lattice& lattice : lattices) {
      coarsen(lattice);
      std::vector<Box>& members = lattice.boxes;
      std::vector<Box> halved = members;
      std::ranges::sort(halved);
      halved.erase(std::unique(halved.begin(), halved.end()), halved.end());
      for (const Box& box : members)
        aggregates.of.push_back(aggregates.count +
                                static_cast<Index>(std::ranges::lower_bound(halved, box) - halved.begin()));
      aggregates.count += static_cast<Index>(halved.size());
      members = std::move(halved);
    }
    const Index of_cloths = aggregates.count;
    for (Index i = first_[cloths()]; i < first_.back(); ++i) aggregates.of.push_back(aggregates.count++);
    aggregate_levels_.push_back(std::move(aggregates));
    is_coarse = of_cloths <= std::max(numerics.linear.coarsest_aggregates, static_cast<Index>(lattices.size()));
  } while (!is_coarse);
}

}  // namespace weft::simulation
