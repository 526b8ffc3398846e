#include "film/garment/start_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "film/garment/least_squares_positions.hpp"
#include "film/garment/triangulation.hpp"

namespace weft::garment {
namespace {

// Weight of the term that pulls each vertex to the start position of its panel, relative to the weight of an edge. The
// weight is so small that this term hardly changes lengths, but it determines where each connected set of panels
// starts.
constexpr double kAnchorWeight = 1e-4;

using VertexPair = std::array<Index, 2>;

// The sides of all triangles as pairs of vertices. Index 0: of front panels; 1: of back panels.
std::array<std::set<VertexPair>, 2> sides_of(std::span<const LaidPanel> panels) {
  std::array<std::set<VertexPair>, 2> sides;
  for (const LaidPanel& panel : panels)
    for (const mesh::Triangle& t : panel.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
        sides[panel.back].insert({low, high});
      }
  return sides;
}

}  // namespace

std::vector<Vec2> lay_together(std::span<const LaidPanel> panels, std::size_t vertices) {
  LeastSquaresPositions<2> places(vertices, kAnchorWeight);
  for (const LaidPanel& panel : panels)
    for (std::size_t t = 0; t < panel.triangles.size(); ++t) places.add(panel.triangles[t], panel.corners[t]);
  return places.solve();
}

std::vector<Vec3> inflate(std::span<const LaidPanel> panels, std::span<const Vec2> plane, double depth) {
  const auto sides = sides_of(panels);
  std::vector<VertexPair> shared;
  std::ranges::set_intersection(sides[0], sides[1], std::back_inserter(shared));
  std::vector<std::vector<Index>> neighbours(plane.size());
  std::vector<char> free(plane.size(), 1);
  std::vector<double> side_sign(plane.size());  // −1 front, 1 back
  for (std::size_t half = 0; half < 2; ++half)
    for (const auto& [a, b] : sides[half]) {
      neighbours[at(a)].push_back(b);
      neighbours[at(b)].push_back(a);
      side_sign[at(a)] = side_sign[at(b)] = half == 0 ? -1 : 1;
    }
  for (const auto& [a, b] : shared) free[at(a)] = free[at(b)] = 0;
  std::vector<int> layers(plane.size(), 0);  // the highest at each vertex
  for (const LaidPanel& panel : panels)
    for (const mesh::Triangle& t : panel.triangles)
      for (const Index v : t) layers[at(v)] = std::max(layers[at(v)], panel.layer);

  std::vector<Vec3> x(plane.size());
  for (std::size_t v = 0; v < plane.size(); ++v) {
    double d = shared.empty() ? depth : std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : shared) d = std::min(d, std::sqrt(distance_sq(plane[v], plane[at(a)], plane[at(b)])));
    d = free[v] ? std::min(d, depth) : 0;
    const double off = free[v] ? kLayerDistance * layers[v] : 0;
    x[v] = {plane[v].x(), side_sign[v] * (std::sqrt(d * (2 * depth - d)) + off), plane[v].y()};
  }
  if (std::ranges::any_of(layers, [](int layer) { return layer > 0; })) return x;
  // Smoothing must not move the rims of openings.
  std::vector<mesh::Triangle> all;
  for (const LaidPanel& panel : panels) all.insert(all.end(), panel.triangles.begin(), panel.triangles.end());
  for (const mesh::Edge& edge : mesh::collect_edges(all).edges)
    if (edge.triangles[1] < 0) free[at(edge.vertices[0])] = free[at(edge.vertices[1])] = 0;
  constexpr int kSmoothingRounds = 10;
  for (int round = 0; round < kSmoothingRounds; ++round) smooth(neighbours, free, x);
  return x;
}

void smooth(const std::vector<std::vector<Index>>& neighbours, const std::vector<char>& chosen, std::span<Vec3> x) {
  const std::vector<Vec3> before(x.begin(), x.end());
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (!chosen[v] || neighbours[v].empty()) continue;
    Vec3 sum = Vec3::Zero();
    for (const Index n : neighbours[v]) sum += before[at(n)];
    x[v] = 0.5 * (before[v] + sum / static_cast<double>(neighbours[v].size()));
  }
}

}  // namespace weft::garment
