#include "untangle/contours.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "collision/proximity/surface_point.hpp"
#include "untangle/solid.hpp"

namespace weft::untangle {
namespace {

// What is folded over lies this steep on what it went through: sine and cosine of 15 degrees.
constexpr double kFoldSine = 0.2588, kFoldCosine = 0.9659;

// Number of the part of its mesh that each particle is in, where `cut` edges do not hold it together.
std::vector<Index> parts_without(const Fabric& fabric, const std::set<std::array<Index, 2>>& cut) {
  std::vector<Index> part(static_cast<std::size_t>(fabric.particles()), -1);
  std::vector<Index> open;
  Index count = 0;
  for (Index first = 0; first < fabric.particles(); ++first) {
    if (part[first] >= 0) continue;
    part[first] = count;
    open.assign(1, first);
    while (!open.empty()) {
      const Index i = open.back();
      open.pop_back();
      for (const Index j : fabric.neighbours[i]) {
        if (part[j] >= 0 || cut.contains({std::min(i, j), std::max(i, j)})) continue;
        part[j] = count;
        open.push_back(j);
      }
    }
    ++count;
  }
  return part;
}

/// A place of the line in which a part is cut off, and the other surface's normal there, to the side of the rest.
struct CutPoint {
  Vec3 place, normal;
};

struct Part {
  std::vector<Index> particles;
  std::set<Index> beside;  // particles of others that it is cut off from
  std::vector<CutPoint> line;
  std::set<Index> through;           // vertices of what it goes through
  std::optional<std::size_t> other;  // body of these, where it is one and not its own
};

const CutPoint& nearest(std::span<const CutPoint> line, const Vec3& p) {
  return *std::ranges::min_element(line, {}, [&](const CutPoint& c) { return (c.place - p).squaredNorm(); });
}

Through through_of(const Fabric& fabric, const Crossing& c) {
  return {fabric.bodies.body_of(fabric.edges.edges[c.edge].vertices[0]),
          fabric.bodies.body_of(fabric.bodies.triangles()[c.triangle][0])};
}

// Adds the edges of a cloth that go from one side of another to its other one where that is prolonged beyond its
// border: sides are those of the plane of the triangle that is gone through nearest to a particle.
void cut_on(const Fabric& fabric, std::span<const Crossing> crossings, std::size_t cloth, std::span<const Vec3> x,
            std::set<std::array<Index, 2>>& cut) {
  std::vector<CutPoint> line;
  for (const Crossing& c : crossings) {
    const auto [i, j] = fabric.edges.edges[c.edge].vertices;
    line.push_back({x[i] + c.share * (x[j] - x[i]), collision::face_normal(fabric.bodies.triangles()[c.triangle], x)});
  }
  const collision::Surface& surface = fabric.bodies.surfaces()[cloth];
  const Index first = surface.first_vertex, end = first + surface.vertex_count;
  std::vector<std::int8_t> side(static_cast<std::size_t>(surface.vertex_count));
  for (Index i = first; i < end; ++i) {
    const CutPoint& at = nearest(line, x[i]);
    side[i - first] = (x[i] - at.place).dot(at.normal) < 0 ? -1 : 1;
  }
  for (const mesh::Edge& edge : fabric.edges.edges) {
    const auto [i, j] = edge.vertices;
    if (i >= first && i < end && side[i - first] != side[j - first]) cut.insert(edge.vertices);
  }
}

// Straight to the other side: of the planes along the line, and of the surface that is nearest then.
std::vector<Move> flatten(const Part& part, const Vec3& up, double height, const collision::BroadPhase& surfaces,
                          std::span<const Vec3> x) {
  std::vector<Move> moves;
  for (const Index i : part.particles) {
    const double h = (x[i] - nearest(part.line, x[i]).place).dot(up);
    Vec3 target = h < height ? Vec3(x[i] + (height - h) * up) : x[i];
    if (part.other) {
      const collision::SurfacePoint point = collision::nearest_point(target, surfaces, *part.other, x);
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

// Around the line, as far from it as it is, toward `away` from it.
std::vector<Move> fold(const Part& part, const Vec3& up, const Vec3& away, double height, std::span<const Vec3> x) {
  std::vector<Move> moves;
  const Vec3 along = up.cross(away);
  for (const Index i : part.particles) {
    const Vec3& place = nearest(part.line, x[i]).place;
    const Vec3 arm = x[i] - place;
    const double reach = (arm - arm.dot(along) * along).norm();
    const Vec3 end = place + arm.dot(along) * along + (kFoldCosine * reach) * away + (kFoldSine * reach + height) * up;
    moves.push_back({i, end});
  }
  return moves;
}

// Main direction of the line, by a few steps of power iteration.
Vec3 direction_of(std::span<const CutPoint> line) {
  Vec3 mean = Vec3::Zero();
  for (const CutPoint& c : line) mean += c.place / static_cast<double>(line.size());
  Mat3 spread = Mat3::Zero();
  for (const CutPoint& c : line) spread += (c.place - mean) * (c.place - mean).transpose();
  Vec3 along(1, 0.3, 0.1);
  for (int step = 0; step < 30; ++step) along = (spread * along + 1e-12 * along).stableNormalized();
  return along;
}

std::vector<Move> best_way(const Fabric& fabric, const Part& part, double height, const collision::BroadPhase& surfaces,
                           std::span<const Vec3> x) {
  Vec3 up = Vec3::Zero();
  for (const CutPoint& c : part.line) up += c.normal;
  if (up.norm() < 0.1 * static_cast<double>(part.line.size())) return {};  // from all sides: no way is better
  up.normalize();
  std::vector<Move> best = flatten(part, up, height, surfaces, x);
  double least = stretch_cost(fabric, best, x);
  const Vec3 away = direction_of(part.line).cross(up).stableNormalized();
  if (away.isZero()) return best;
  // Rather to where it leans already.
  Vec3 lean = Vec3::Zero();
  for (const Index i : part.particles) lean += x[i] - nearest(part.line, x[i]).place;
  const double side = lean.dot(away) < 0 ? -1 : 1;
  for (const double sign : {side, -side}) {
    std::vector<Move> moves = fold(part, up, sign * away, height, x);
    const double cost = stretch_cost(fabric, moves, x);
    if (cost >= 0.9 * least) continue;
    least = cost;
    best = std::move(moves);
  }
  return best;
}

}  // namespace

std::vector<Through> list_through(const Fabric& fabric, std::span<const Crossing> crossings) {
  std::set<Through> found;
  for (const Crossing& c : crossings)
    if (!with_solid(fabric, c) && fabric.is_cloth(fabric.edges.edges[c.edge].vertices[0]))
      found.insert(through_of(fabric, c));
  return {found.begin(), found.end()};
}

std::vector<std::vector<Move>> move_cut_off_parts(const Fabric& fabric, std::span<const Crossing> all_crossings,
                                                  const collision::BroadPhase& surfaces, std::span<const double> above,
                                                  const std::optional<Through>& only, std::span<const Vec3> x) {
  std::vector<Crossing> crossings;
  std::ranges::copy_if(all_crossings, std::back_inserter(crossings), [&](const Crossing& c) {
    if (with_solid(fabric, c) || !fabric.is_cloth(fabric.edges.edges[c.edge].vertices[0])) return false;
    return !only || through_of(fabric, c) == *only;
  });
  std::set<std::array<Index, 2>> cut;
  for (const Crossing& c : crossings) cut.insert(fabric.edges.edges[c.edge].vertices);
  if (only && only->cloth != only->other) cut_on(fabric, crossings, only->cloth, x, cut);
  const std::vector<Index> whole = parts_without(fabric, {}), part_of = parts_without(fabric, cut);
  const Index count = part_of.empty() ? 0 : 1 + *std::ranges::max_element(part_of);
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (Index i = 0; i < fabric.particles(); ++i) parts[part_of[i]].particles.push_back(i);
  std::vector<Index> largest(parts.size(), -1);  // per connected mesh
  for (Index p = 0; p < count; ++p) {
    Index& best = largest[whole[parts[p].particles.front()]];
    if (best < 0 || parts[p].particles.size() > parts[best].particles.size()) best = p;
  }
  for (const Crossing& c : crossings) {
    const auto [i, j] = fabric.edges.edges[c.edge].vertices;
    if (part_of[i] == part_of[j]) continue;
    const collision::Triangle& t = fabric.bodies.triangles()[c.triangle];
    const Vec3 place = x[i] + c.share * (x[j] - x[i]);
    Vec3 normal = collision::face_normal(t, x);
    if (normal.dot(x[j] - x[i]) < 0) normal = -normal;
    const Through through = through_of(fabric, c);
    for (const auto& [inner, outer, sign] : {std::tuple{i, j, 1.0}, {j, i, -1.0}}) {
      Part& part = parts[part_of[inner]];
      part.beside.insert(outer);
      part.line.push_back({place, sign * normal});
      part.through.insert(t.begin(), t.end());
      part.other = through.other;
    }
  }

  std::vector<Index> order(parts.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [&](Index p) { return parts[p].particles.size(); });
  std::vector<std::uint8_t> moved(x.size(), 0);
  std::vector<std::vector<Move>> all;
  const auto has_moved = [&](Index v) { return moved[v] != 0; };
  for (const Index p : order) {
    Part& part = parts[p];
    const bool stays = largest[whole[part.particles.front()]] == p || part.line.empty() ||
                       std::ranges::any_of(part.through, has_moved) || std::ranges::any_of(part.beside, has_moved) ||
                       std::ranges::any_of(part.particles, [&](Index i) { return !fabric.movable[i]; });
    if (stays) continue;
    const std::size_t cloth = fabric.bodies.body_of(part.particles.front());
    const double height = above[cloth];
    const auto is_other = [&](Index v) { return fabric.bodies.body_of(v) == part.other; };
    if (part.other == cloth || !std::ranges::all_of(part.through, is_other)) part.other.reset();
    std::vector<Move> moves = best_way(fabric, part, height, surfaces, x);
    for (const Move& move : moves) moved[move.particle] = 1;
    if (!moves.empty()) all.push_back(std::move(moves));
  }
  return all;
}

void shorten_contours(const Fabric& fabric, std::span<const Crossing> crossings, double length, std::span<Vec3> x) {
  std::vector<Vec3> push(x.size(), Vec3::Zero());
  std::vector<double> weight(x.size(), 0);
  for (const Crossing& c : crossings) {
    if (with_solid(fabric, c)) continue;
    const mesh::Edge& edge = fabric.edges.edges[c.edge];
    const auto [i, j] = edge.vertices;
    const collision::Triangle& t = fabric.bodies.triangles()[c.triangle];
    const Vec3 n = collision::face_normal(t, x), e = (x[j] - x[i]).stableNormalized();
    const double across = e.dot(n);
    if (std::abs(across) < 1e-3) continue;
    // Volino & Magnenat-Thalmann (2006), Eq. (2): R runs from the edge into each of its triangles, along the line.
    Vec3 gradient = Vec3::Zero();
    for (const Index triangle : edge.triangles) {
      if (triangle < 0) continue;
      const collision::Triangle& beside = fabric.bodies.triangles()[triangle];
      Index third = beside[0];
      for (const Index v : beside)
        if (v != i && v != j) third = v;
      Vec3 r = collision::face_normal(beside, x).cross(n).stableNormalized();
      const Vec3 arm = x[third] - x[i];
      if (r.dot(arm - arm.dot(e) * e) < 0) r = -r;
      gradient += r - 2 * e.dot(r) / across * n;
    }
    // The same way for all but the flattest contours, which hardly know one.
    const Vec3 way = gradient / std::sqrt(gradient.squaredNorm() + 0.01);
    const auto add = [&](Index v, double share, double sign) {
      push[v] += sign * share * way;
      weight[v] += share;
    };
    add(i, 1 - c.share, 1);
    add(j, c.share, 1);
    for (std::size_t k = 0; k < 3; ++k) add(t[k], c.weights[k], -1);
  }
  for (Index v = 0; v < fabric.particles(); ++v)
    if (weight[v] > 0 && fabric.movable[v]) x[v] += length * push[v] / std::max(weight[v], 0.5);
}

void push_off(const Fabric& fabric, std::span<const Crossing> crossings, std::span<const Solid> solids,
              std::span<const double> above, std::span<Vec3> x) {
  const auto raise = [&](const Solid& solid, std::span<const Index> corners, std::span<const double> weights,
                         double height) {
    Vec3 p = Vec3::Zero();
    double sum_sq = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      p += weights[k] * x[corners[k]];
      sum_sq += fabric.movable[corners[k]] ? weights[k] * weights[k] : 0;
    }
    const Solid::Exit exit = solid.exit(p);
    if (exit.height >= height || sum_sq == 0) return;
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (fabric.movable[corners[k]]) x[corners[k]] += (height - exit.height) * weights[k] / sum_sq * exit.normal;
  };
  for (const Crossing& c : crossings) {
    if (!with_solid(fabric, c)) continue;
    const std::array<Index, 2>& edge = fabric.edges.edges[c.edge].vertices;
    const collision::Triangle& t = fabric.bodies.triangles()[c.triangle];
    const bool cloth_edge = fabric.is_cloth(edge[0]);
    const std::size_t cloth = fabric.bodies.body_of(cloth_edge ? edge[0] : t[0]),
                      body = fabric.bodies.body_of(cloth_edge ? t[0] : edge[0]);
    const auto solid = std::ranges::find(solids, body, &Solid::number);
    if (cloth_edge) {
      for (const double share : {0.5, 0.25, 0.75, c.share})
        raise(*solid, edge, std::array{1 - share, share}, above[cloth]);
    } else {
      // As far as the nearer end of the edge sticks through.
      const double out = std::min(c.share, 1 - c.share) * (x[edge[1]] - x[edge[0]]).norm();
      const double longest =
          std::max({(x[t[1]] - x[t[0]]).norm(), (x[t[2]] - x[t[1]]).norm(), (x[t[0]] - x[t[2]]).norm()});
      raise(*solid, t, c.weights, above[cloth] + std::min(out, 0.5 * longest));
    }
  }
}

}  // namespace weft::untangle
