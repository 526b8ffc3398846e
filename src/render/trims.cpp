#include "render/trims.hpp"

#include <algorithm>
#include <deque>
#include <unordered_map>
#include <utility>

namespace weft::render {
namespace {

std::uint64_t key(Index a, Index b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}

/// Puts edges that follow each other in one row and says where along it each begins.
template <class Segment>
void measure(std::vector<Segment>& segments, std::span<const Vec2> uv) {
  std::unordered_multimap<Index, std::size_t> by_start;
  std::unordered_map<Index, int> ends;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    by_start.emplace(segments[i].a, i);
    ++ends[segments[i].b];
  }
  std::vector<char> done(segments.size(), 0);
  const auto walk = [&](std::size_t first) {
    double along = 0;
    for (std::size_t i = first;;) {
      done[i] = 1;
      segments[i].start = along;
      along += (uv[segments[i].b] - uv[segments[i].a]).norm();
      // Of several ways on the first of the list, whatever the order of the map.
      std::size_t next = segments.size();
      const auto [from, to] = by_start.equal_range(segments[i].b);
      for (auto it = from; it != to; ++it)
        if (!done[it->second]) next = std::min(next, it->second);
      if (next == segments.size()) return;
      i = next;
    }
  };
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!done[i] && !ends.contains(segments[i].a)) walk(i);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!done[i]) walk(i);
}

}  // namespace

Trims::Trims(const frame::Surface& surface) : uv_(surface.uv) {
  const auto& triangles = surface.triangles;
  std::unordered_map<std::uint64_t, std::int32_t> owner;  // of each edge in its way
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      owner.emplace(key(triangles[t][k], triangles[t][(k + 1) % 3]), static_cast<std::int32_t>(t));
  const auto& parts = surface.part_of_triangle;
  std::vector<Segment> borders, seams;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      const auto other = owner.find(key(b, a));
      if (other == owner.end()) {
        rims_.push_back({a, b, static_cast<std::int32_t>(t)});
        borders.push_back({a, b, 0});
      } else if (parts.size() == triangles.size() && parts[t] < parts[static_cast<std::size_t>(other->second)]) {
        seams.push_back({a, b, 0});
      }
    }
  }
  if (uv_.empty()) return;
  std::vector<std::vector<Index>> neighbors(uv_.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) neighbors[t[k]].insert(neighbors[t[k]].end(), {t[(k + 1) % 3], t[(k + 2) % 3]});
  borders_ = lines(std::move(borders), neighbors);
  seams_ = lines(std::move(seams), neighbors);
}

Trims::Place Trims::place(const Lines& lines, std::int32_t segment, const Vec2& at) const {
  if (segment < 0) return {};
  const Segment& line = lines.segments[segment];
  const Vec2 from = uv_[line.a], way = uv_[line.b] - from;
  const double length = way.norm();
  if (!(length > 0)) return {(at - from).norm(), line.start};
  const double along = std::clamp((at - from).dot(way) / length, 0.0, length);
  return {(at - from - along / length * way).norm(), line.start + along};
}

/// Hands what is nearest on from vertex to vertex, so that a line counts along the cloth: panels that are laid
/// together may come to lie over each other.
Trims::Lines Trims::lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const {
  measure(segments, uv_);
  Lines result{std::move(segments), std::vector<std::int32_t>(uv_.size(), -1)};
  std::vector<double> distance(uv_.size(), kNoTrim);
  std::deque<Index> changed;
  const auto offer = [&](Index vertex, std::int32_t segment) {
    const double here = place(result, segment, uv_[vertex]).distance;
    if (here >= distance[vertex]) return;
    distance[vertex] = here;
    result.nearest[vertex] = segment;
    changed.push_back(vertex);
  };
  for (std::size_t i = 0; i < result.segments.size(); ++i) {
    for (const Index end : {result.segments[i].a, result.segments[i].b}) {
      offer(end, static_cast<std::int32_t>(i));
      for (const Index next : neighbors[end]) offer(next, static_cast<std::int32_t>(i));
    }
  }
  for (; !changed.empty(); changed.pop_front())
    for (const Index next : neighbors[changed.front()]) offer(next, result.nearest[changed.front()]);
  return result;
}

Trim Trims::trim(const Vec2& at, std::span<const Index> near) const {
  const auto nearest = [&](const Lines& lines) {
    Place best;
    for (const Index vertex : near)
      if (const Place here = place(lines, lines.nearest[vertex], at); here.distance < best.distance) best = here;
    return best;
  };
  const Place border = nearest(borders_), seam = nearest(seams_);
  return {static_cast<float>(border.distance), static_cast<float>(seam.distance),
          static_cast<float>(border.distance <= seam.distance ? border.along : seam.along)};
}

Trim Trims::at(Index vertex) const {
  if (uv_.empty()) return {kNoTrim, kNoTrim, 0};
  return trim(uv_[vertex], std::span(&vertex, 1));
}

Trim Trims::middle(Index a, Index b) const {
  if (uv_.empty()) return {kNoTrim, kNoTrim, 0};
  const Index ends[] = {a, b};
  return trim(0.5 * (uv_[a] + uv_[b]), ends);
}

double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows) {
  const double edge = (look.hem > 0 ? 2 : 1) * look.thickness;
  if (edge <= 0) return 0;
  double nearest = 1e9;
  for (const Vec3& p : positions) nearest = std::min(nearest, view.axes.forward.dot(p - view.eye));
  const double pixel = 2 * view.tan_half_height * std::max(nearest, view.near) / rows;
  const double share = std::clamp(edge / pixel - 1, 0.0, 1.0);
  return edge * share * share * (3 - 2 * share);
}

RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness) {
  RimStrip strip;
  // Away from the cloth at each vertex of a border: from both edges that meet there.
  std::unordered_map<Index, Vec3> outward;
  for (const auto& [a, b, triangle] : rims) {
    const Vec3 way = positions[b] - positions[a];
    for (const Index end : {a, b}) {
      const Vec3 out = way.cross(normals[end]);
      const auto [entry, added] = outward.try_emplace(end, out);
      if (!added) entry->second += out;
    }
  }
  std::unordered_map<Index, Index> first;  // of the two vertices of the strip
  const auto vertex = [&](Index v) {
    const auto [entry, added] = first.try_emplace(v, static_cast<Index>(strip.positions.size()));
    if (!added) return entry->second;
    const Vec3 sum = outward[v], out = sum.norm() > 0 ? Vec3(sum.normalized()) : normals[v];
    strip.positions.insert(strip.positions.end(), {positions[v], positions[v] - thickness * normals[v]});
    // Round, as a fold is.
    strip.normals.insert(strip.normals.end(), {(out + normals[v]).normalized(), (out - normals[v]).normalized()});
    strip.source.insert(strip.source.end(), {v, v});
    return entry->second;
  };
  for (const auto& [a, b, triangle] : rims) {
    const Index p = vertex(a), q = vertex(b);
    strip.triangles.insert(strip.triangles.end(), {{p, p + 1, q}, {q, p + 1, q + 1}});
    strip.owner.insert(strip.owner.end(), {triangle, triangle});
  }
  return strip;
}

}  // namespace weft::render
