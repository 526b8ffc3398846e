#include "physics/untangle/problem.hpp"

#include <algorithm>
#include <unordered_map>

namespace weft::untangle {
namespace {

// Height over an obstacle or other cloth to which cloth is moved, relative to the thickness of the moved cloth.
constexpr double kHeightInThicknesses = 0.75;
// Minimum length of a link, relative to the smaller of its lengths at the start and at rest. It is below 1, because
// compressed threads buckle when the run begins.
constexpr double kMinLengthRatio = 0.6;

}  // namespace

UntangleInput::UntangleInput(const collision::Bodies& of_bodies, std::vector<SurfaceKind> of_kinds,
                             std::span<const Vec3> x, std::span<const Vec3> rest,
                             std::span<const std::uint8_t> may_move)
    : bodies(of_bodies),
      kinds(std::move(of_kinds)),
      movable(may_move),
      edges(mesh::collect_edges(of_bodies.triangles())),
      neighbours(rest.size()),
      on_border(x.size(), 0),
      can_move(of_bodies.size(), 0) {
  for (std::size_t b = 0; b < bodies.size(); ++b) min_height.push_back(kHeightInThicknesses * bodies[b].thickness);
  for (Index i = 0; i < particles(); ++i) can_move[bodies.body_of(i)] |= movable[i];
  const auto add = [&](Index i, Index j, bool bend) {
    const double at_start = (x[i] - x[j]).norm(), at_rest = (rest[i] - rest[j]).norm();
    links.push_back({i, j, kMinLengthRatio * std::min(at_start, at_rest), std::max(at_start, at_rest), bend});
  };
  const auto third = [&](Index triangle, const mesh::Edge& edge) {
    for (const Index v : bodies.triangles()[triangle])
      if (v != edge.vertices[0] && v != edge.vertices[1]) return v;
    return edge.vertices[0];
  };
  for (const mesh::Edge& edge : edges.edges) {
    const auto [i, j] = edge.vertices;
    if (edge.triangles[1] < 0) on_border[i] = on_border[j] = 1;
    if (!is_cloth(i) || i == j) continue;  // a piece of rope (a, b, b) has an edge from b to b
    neighbours[i].push_back(j);
    neighbours[j].push_back(i);
    add(i, j, false);
    const bool is_hinge = edge.triangles[1] >= 0 && edge.triangles[0] != edge.triangles[1];
    if (is_hinge) add(third(edge.triangles[0], edge), third(edge.triangles[1], edge), true);
  }
}

double stretch_cost(const UntangleInput& input, std::span<const Move> moves, std::span<const Vec3> x) {
  std::unordered_map<Index, Vec3> targets;
  for (const Move& move : moves) targets.emplace(move.particle, move.target);
  const auto at = [&](Index i) {
    const auto found = targets.find(i);
    return found == targets.end() ? x[i] : found->second;
  };
  double sum = 0;
  std::size_t count = 0;
  for (const UntangleInput::Link& link : input.links) {
    if (link.is_bend || (!targets.contains(link.i) && !targets.contains(link.j))) continue;
    const double now = (x[link.i] - x[link.j]).norm(), then = (at(link.i) - at(link.j)).norm();
    const double beyond = then / std::max(link.max_length, now) - 1, below = 1 - then / std::min(link.min_length, now);
    const double error = std::max({beyond, below, 0.0});
    sum += error * error;
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace weft::untangle
