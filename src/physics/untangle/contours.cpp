#include "physics/untangle/contours.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "core/disjoint_sets.hpp"
#include "physics/collision/proximity/surface_point.hpp"
#include "physics/untangle/forbidden_region.hpp"

namespace weft::untangle {
namespace {

// Sine and cosine of the angle between a folded island (see label_islands()) and the surface that it crossed: 15
// degrees.
constexpr double kFoldSine = 0.2588, kFoldCosine = 0.9659;

// Returns the number of the island of each particle. An island is a connected component of the mesh without the edges
// in `cut`.
std::vector<Index> label_islands(const UntangleInput& input, const std::set<std::array<Index, 2>>& cut) {
  DisjointSets joined(static_cast<std::size_t>(input.particles()));
  for (Index i = 0; i < input.particles(); ++i)
    for (const Index j : input.neighbours[i])
      if (i < j && !cut.contains({i, j})) joined.join(i, j);
  std::vector<Index> island;
  Index count = 0;
  for (Index i = 0; i < input.particles(); ++i) {
    const Index first = joined.root(i);
    island.push_back(first == i ? count++ : island[first]);
  }
  return island;
}

/// A point of the line of crossing, and the normal of the crossed surface there. In Island::line, the normal points
/// from the island to the adjacent part of its own mesh.
struct CutPoint {
  Vec3 place, normal;
};

struct Island {
  std::vector<Index> particles;
  std::set<Index> adjacent_particles;  // particles of other islands at the other ends of cut edges
  std::vector<CutPoint> line;          // line of crossing that cuts the island off
  std::set<Index> crossed_vertices;    // corners of the crossed triangles
  std::optional<std::size_t> other;    // the crossed body; none if several are crossed, or only the island's own cloth
};

const CutPoint& nearest(std::span<const CutPoint> line, const Vec3& p) {
  return *std::ranges::min_element(line, {}, [&](const CutPoint& c) { return (c.place - p).squaredNorm(); });
}

CrossedPair crossed_pair_of(const UntangleInput& input, const Crossing& c) {
  return {input.bodies.body_of(input.edges.edges[c.edge].vertices[0]),
          input.bodies.body_of(input.bodies.triangles()[c.triangle][0])};
}

// Adds to `cut` the edges of the body `cloth` that would cross the other surface if that surface were extended beyond
// its border: those whose two particles are on different sides of it. The side of a particle is its side of the plane
// of one crossed triangle, the one whose crossing point is nearest to the particle.
void extend_cut(const UntangleInput& input, std::span<const Crossing> crossings, std::size_t cloth,
                std::span<const Vec3> x, std::set<std::array<Index, 2>>& cut) {
  std::vector<CutPoint> line;
  for (const Crossing& c : crossings) {
    const auto [i, j] = input.edges.edges[c.edge].vertices;
    line.push_back(
        {x[i] + c.fraction * (x[j] - x[i]), collision::face_normal(input.bodies.triangles()[c.triangle], x)});
  }
  const collision::Surface& surface = input.bodies.surfaces()[cloth];
  const Index first = surface.first_vertex, end = first + surface.vertex_count;
  std::vector<std::int8_t> side(static_cast<std::size_t>(surface.vertex_count));
  for (Index i = first; i < end; ++i) {
    const CutPoint& at = nearest(line, x[i]);
    side[i - first] = (x[i] - at.place).dot(at.normal) < 0 ? -1 : 1;
  }
  for (const mesh::Edge& edge : input.edges.edges) {
    const auto [i, j] = edge.vertices;
    if (i >= first && i < end && side[i - first] != side[j - first]) cut.insert(edge.vertices);
  }
}

// Moves that raise the particles of the island along `up` to at least `height` above the plane perpendicular to `up`
// through the nearest point of the line. If the island crosses a single other surface, the moves also raise the
// particles to at least `height` above that surface, along its normal (reversed if it points away from `up`).
std::vector<Move> flatten(const Island& island, const Vec3& up, double height, const collision::BroadPhase& surfaces,
                          std::span<const Vec3> x) {
  std::vector<Move> moves;
  for (const Index i : island.particles) {
    const double h = (x[i] - nearest(island.line, x[i]).place).dot(up);
    Vec3 target = h < height ? Vec3(x[i] + (height - h) * up) : x[i];
    if (island.other) {
      const collision::SurfacePoint point = collision::nearest_point(target, surfaces, *island.other, x);
      const Vec3 place = target - point.height * point.normal;
      Vec3 n = collision::face_normal(point.face, x);
      if (n.dot(up) < 0) n = -n;
      const double over = (target - place).dot(n);
      if (over < height) target += (height - over) * n;
    }
    if (target != x[i]) moves.push_back({i, target});
  }
  return moves;
}

// Moves that rotate each particle around the line, at constant distance from it, until the particle is 15 degrees above
// the direction `away`; then raise it by `height` along `up`.
std::vector<Move> fold(const Island& island, const Vec3& up, const Vec3& away, double height, std::span<const Vec3> x) {
  std::vector<Move> moves;
  const Vec3 along = up.cross(away);
  for (const Index i : island.particles) {
    const Vec3& place = nearest(island.line, x[i]).place;
    const Vec3 arm = x[i] - place;
    const double radius = (arm - arm.dot(along) * along).norm();
    const Vec3 end =
        place + arm.dot(along) * along + (kFoldCosine * radius) * away + (kFoldSine * radius + height) * up;
    moves.push_back({i, end});
  }
  return moves;
}

// Principal direction of the line, by power iteration.
Vec3 direction_of(std::span<const CutPoint> line) {
  Vec3 mean = Vec3::Zero();
  for (const CutPoint& c : line) mean += c.place / static_cast<double>(line.size());
  Mat3 spread = Mat3::Zero();
  for (const CutPoint& c : line) spread += (c.place - mean) * (c.place - mean).transpose();
  Vec3 along(1, 0.3, 0.1);
  for (int step = 0; step < 30; ++step) along = (spread * along + 1e-12 * along).stableNormalized();
  return along;
}

// Returns the cheapest moves (stretch_cost()) that take the island to the side of the crossed surface on which the
// adjacent part of its own mesh is: by flattening, or by folding to one of two sides. Folding must cost a tenth less
// than the best candidate so far. Empty if the normals along the line cancel each other.
std::vector<Move> best_moves(const UntangleInput& input, const Island& island, double height,
                             const collision::BroadPhase& surfaces, std::span<const Vec3> x) {
  Vec3 up = Vec3::Zero();
  for (const CutPoint& c : island.line) up += c.normal;
  if (up.norm() < 0.1 * static_cast<double>(island.line.size())) return {};
  up.normalize();
  std::vector<Move> best = flatten(island, up, height, surfaces, x);
  double min_cost = stretch_cost(input, best, x);
  const Vec3 away = direction_of(island.line).cross(up).stableNormalized();
  if (away.isZero()) return best;
  // Try first the side on which most of the island lies.
  Vec3 offset_sum = Vec3::Zero();
  for (const Index i : island.particles) offset_sum += x[i] - nearest(island.line, x[i]).place;
  const double side = offset_sum.dot(away) < 0 ? -1 : 1;
  for (const double sign : {side, -side}) {
    std::vector<Move> moves = fold(island, up, sign * away, height, x);
    const double cost = stretch_cost(input, moves, x);
    if (cost >= 0.9 * min_cost) continue;
    min_cost = cost;
    best = std::move(moves);
  }
  return best;
}

}  // namespace

std::vector<CrossedPair> list_crossed_pairs(const UntangleInput& input, std::span<const Crossing> crossings) {
  std::set<CrossedPair> found;
  for (const Crossing& c : crossings)
    if (!involves_solid(input, c) && input.is_cloth(input.edges.edges[c.edge].vertices[0]))
      found.insert(crossed_pair_of(input, c));
  return {found.begin(), found.end()};
}

std::vector<std::vector<Move>> move_cut_off_islands(const UntangleInput& input, std::span<const Crossing> all_crossings,
                                                    const collision::BroadPhase& surfaces,
                                                    const std::optional<CrossedPair>& only, std::span<const Vec3> x) {
  std::vector<Crossing> crossings;
  std::ranges::copy_if(all_crossings, std::back_inserter(crossings), [&](const Crossing& c) {
    if (involves_solid(input, c) || !input.is_cloth(input.edges.edges[c.edge].vertices[0])) return false;
    return !only || crossed_pair_of(input, c) == *only;
  });
  std::set<std::array<Index, 2>> cut;
  for (const Crossing& c : crossings) cut.insert(input.edges.edges[c.edge].vertices);
  if (only && only->cloth != only->other) extend_cut(input, crossings, only->cloth, x, cut);
  const std::vector<Index> whole = label_islands(input, {}), island_of = label_islands(input, cut);
  const Index count = island_of.empty() ? 0 : 1 + *std::ranges::max_element(island_of);
  std::vector<Island> islands(static_cast<std::size_t>(count));
  for (Index i = 0; i < input.particles(); ++i) islands[island_of[i]].particles.push_back(i);
  std::vector<Index> largest(islands.size(), -1);  // per connected mesh
  for (Index p = 0; p < count; ++p) {
    Index& best = largest[whole[islands[p].particles.front()]];
    if (best < 0 || islands[p].particles.size() > islands[best].particles.size()) best = p;
  }
  for (const Crossing& c : crossings) {
    const auto [i, j] = input.edges.edges[c.edge].vertices;
    if (island_of[i] == island_of[j]) continue;
    const collision::Triangle& t = input.bodies.triangles()[c.triangle];
    const Vec3 place = x[i] + c.fraction * (x[j] - x[i]);
    Vec3 normal = collision::face_normal(t, x);
    if (normal.dot(x[j] - x[i]) < 0) normal = -normal;
    const CrossedPair crossed_pair = crossed_pair_of(input, c);
    for (const auto& [inner, outer, sign] : {std::tuple{i, j, 1.0}, {j, i, -1.0}}) {
      Island& island = islands[island_of[inner]];
      island.adjacent_particles.insert(outer);
      island.line.push_back({place, sign * normal});
      island.crossed_vertices.insert(t.begin(), t.end());
      island.other = crossed_pair.other;
    }
  }

  std::vector<Index> order(islands.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [&](Index p) { return islands[p].particles.size(); });
  std::vector<std::uint8_t> moved(x.size(), 0);
  std::vector<std::vector<Move>> all;
  const auto has_moved = [&](Index v) { return moved[v] != 0; };
  for (const Index p : order) {
    Island& island = islands[p];
    const bool stays = largest[whole[island.particles.front()]] == p || island.line.empty() ||
                       std::ranges::any_of(island.crossed_vertices, has_moved) ||
                       std::ranges::any_of(island.adjacent_particles, has_moved) ||
                       std::ranges::any_of(island.particles, [&](Index i) { return !input.movable[i]; });
    if (stays) continue;
    const std::size_t cloth = input.bodies.body_of(island.particles.front());
    const double height = input.min_height[cloth];
    const auto is_other = [&](Index v) { return input.bodies.body_of(v) == island.other; };
    if (island.other == cloth || !std::ranges::all_of(island.crossed_vertices, is_other)) island.other.reset();
    std::vector<Move> moves = best_moves(input, island, height, surfaces, x);
    for (const Move& move : moves) moved[move.particle] = 1;
    if (!moves.empty()) all.push_back(std::move(moves));
  }
  return all;
}

void shorten_contours(const UntangleInput& input, std::span<const Crossing> crossings, double length,
                      std::span<Vec3> x) {
  std::vector<Vec3> push(x.size(), Vec3::Zero());
  std::vector<double> weight(x.size(), 0);
  for (const Crossing& c : crossings) {
    if (involves_solid(input, c)) continue;
    const mesh::Edge& edge = input.edges.edges[c.edge];
    const auto [i, j] = edge.vertices;
    const collision::Triangle& t = input.bodies.triangles()[c.triangle];
    const Vec3 n = collision::face_normal(t, x), e = (x[j] - x[i]).stableNormalized();
    const double across = e.dot(n);
    if (std::abs(across) < 1e-3) continue;
    // Volino & Magnenat-Thalmann (2006), Eq. (2). r: direction of the line, from the edge into each of its triangles.
    Vec3 gradient = Vec3::Zero();
    for (const Index triangle : edge.triangles) {
      if (triangle < 0) continue;
      const collision::Triangle& adjacent_triangle = input.bodies.triangles()[triangle];
      Index third = adjacent_triangle[0];
      for (const Index v : adjacent_triangle)
        if (v != i && v != j) third = v;
      Vec3 r = collision::face_normal(adjacent_triangle, x).cross(n).stableNormalized();
      const Vec3 arm = x[third] - x[i];
      if (r.dot(arm - arm.dot(e) * e) < 0) r = -r;
      gradient += r - 2 * e.dot(r) / across * n;
    }
    // A unit vector, except if the gradient is small: its direction is then uncertain, so `direction` is shorter.
    const Vec3 direction = gradient / std::sqrt(gradient.squaredNorm() + 0.01);
    const auto add = [&](Index v, double fraction, double sign) {
      push[v] += sign * fraction * direction;
      weight[v] += fraction;
    };
    add(i, 1 - c.fraction, 1);
    add(j, c.fraction, 1);
    for (std::size_t k = 0; k < 3; ++k) add(t[k], c.weights[k], -1);
  }
  for (Index v = 0; v < input.particles(); ++v)
    if (weight[v] > 0 && input.movable[v]) x[v] += length * push[v] / std::max(weight[v], 0.5);
}

void push_out_of_solids(const UntangleInput& input, std::span<const Crossing> crossings,
                        std::span<const ForbiddenRegion> solids, std::span<Vec3> x) {
  const auto raise = [&](const ForbiddenRegion& solid, std::span<const Index> corners, std::span<const double> weights,
                         double height) {
    Vec3 p = Vec3::Zero();
    double sum_sq = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      p += weights[k] * x[corners[k]];
      sum_sq += input.movable[corners[k]] ? weights[k] * weights[k] : 0;
    }
    const ForbiddenRegion::Exit exit = solid.find_exit(p);
    if (exit.height >= height || sum_sq == 0) return;
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (input.movable[corners[k]]) x[corners[k]] += (height - exit.height) * weights[k] / sum_sq * exit.normal;
  };
  for (const Crossing& c : crossings) {
    if (!involves_solid(input, c)) continue;
    const std::array<Index, 2>& edge = input.edges.edges[c.edge].vertices;
    const collision::Triangle& t = input.bodies.triangles()[c.triangle];
    const bool cloth_edge = input.is_cloth(edge[0]);
    const std::size_t cloth = input.bodies.body_of(cloth_edge ? edge[0] : t[0]),
                      body = input.bodies.body_of(cloth_edge ? t[0] : edge[0]);
    const auto solid = std::ranges::find(solids, body, &ForbiddenRegion::number);
    if (cloth_edge) {
      for (const double fraction : {0.5, 0.25, 0.75, c.fraction})
        raise(*solid, edge, std::array{1 - fraction, fraction}, input.min_height[cloth]);
    } else {
      // An edge of the body crosses a triangle of cloth. Raise the crossing point higher than `min_height` by the
      // length of the shorter part of the edge, but at most by half the longest side of the triangle.
      const double out = std::min(c.fraction, 1 - c.fraction) * (x[edge[1]] - x[edge[0]]).norm();
      const double longest =
          std::max({(x[t[1]] - x[t[0]]).norm(), (x[t[2]] - x[t[1]]).norm(), (x[t[0]] - x[t[2]]).norm()});
      raise(*solid, t, c.weights, input.min_height[cloth] + std::min(out, 0.5 * longest));
    }
  }
}

}  // namespace weft::untangle
