// Small surfaces for the tests of the hierarchy and of near pairs.
#pragma once

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "physics/collision/hierarchy/surface.hpp"

namespace weft::collision::testing {

struct TestMesh {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;

  Surface surface() const { return {triangles, 0, 0, static_cast<Index>(x.size())}; }
};

/// Number of common vertices; a vertex that a triangle names twice counts once.
inline std::size_t shared_count(const Triangle& a, const Triangle& b) {
  const std::set<Index> of_a(a.begin(), a.end()), of_b(b.begin(), b.end());
  return static_cast<std::size_t>(std::count_if(of_a.begin(), of_a.end(), [&](Index v) { return of_b.contains(v); }));
}

inline Vec3 random_vec(std::mt19937& generator) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double a = unit(generator), b = unit(generator), c = unit(generator);
  return {a, b, c};
}

/// Random triangles between few vertices: many share a vertex or an edge; some are equal, or name a vertex twice.
/// `vertices`: number of clusters of five vertices. `size`: of a cluster [m].
inline TestMesh triangle_soup(unsigned seed, int vertices, int triangles, double size) {
  std::mt19937 generator(seed);
  TestMesh mesh;
  for (int v = 0; v < vertices; ++v) {
    const Vec3 centre = random_vec(generator);
    for (int i = 0; i < 5; ++i) mesh.x.push_back(centre + size * random_vec(generator));
  }
  const auto pick = [&](int count) { return static_cast<Index>(generator() % static_cast<unsigned>(count)); };
  for (int t = 0; t < triangles; ++t) {
    const Index cluster = 5 * pick(vertices);
    mesh.triangles.push_back({cluster + pick(5), cluster + pick(5), cluster + pick(5)});
  }
  return mesh;
}

/// Triangles of a grid of n × n vertices, which are numbered row by row.
inline std::vector<Triangle> grid_triangles(Index n) {
  std::vector<Triangle> triangles;
  for (Index j = 0; j + 1 < n; ++j)
    for (Index a = n * j; a + 1 < n * (j + 1); ++a) {
      triangles.push_back({a, a + 1, a + 1 + n});
      triangles.push_back({a, a + 1 + n, a + n});
    }
  return triangles;
}

/// A sheet of n × n vertices, 1 m × 1 m, folded back and forth into `layers` layers that are `gap` [m] apart.
inline TestMesh folded_sheet(int n, int layers, double gap) {
  TestMesh mesh;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / (n - 1) * layers;
      const int layer = std::min(static_cast<int>(u), layers - 1);
      const double along = u - layer;
      mesh.x.emplace_back((layer % 2 == 0 ? along : 1 - along) / layers, static_cast<double>(j) / (n - 1),
                          gap * (layer + along * along));
    }
  }
  mesh.triangles = grid_triangles(n);
  return mesh;
}

}  // namespace weft::collision::testing
