#include "film/render/trims.hpp"

#include <algorithm>
#include <deque>
#include <unordered_map>
#include <utility>

namespace weft::render {
namespace {

std::uint64_t key(Index a, Index b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}

constexpr double kMaxSmoothCosine = 0.87;  // cosine of 30 degrees; a border that turns by more has a corner

/// Assigns the two kinds of borders alternately to the sides of a border; a side ends at corners. If the border is
/// closed and has corners, its first side begins at a corner; if its number of sides is odd, the first and the last
/// side have the same kind.
template <class Segment>
void assign_border_kinds(std::vector<Segment>& segments, std::span<const std::size_t> chain, std::span<const Vec2> uv) {
  const auto direction = [&](std::size_t k) { return Vec2(uv[segments[chain[k]].b] - uv[segments[chain[k]].a]); };
  const auto corner_before = [&](std::size_t k) {
    // Edges that do not meet at one place are on different sides of a seam, and form no corner.
    if (segments[chain[(k + chain.size() - 1) % chain.size()]].b != segments[chain[k]].a) return false;
    const Vec2 before = direction((k + chain.size() - 1) % chain.size()), after = direction(k);
    return before.dot(after) < kMaxSmoothCosine * before.norm() * after.norm();
  };
  std::size_t from = 0;
  if (segments[chain.back()].to == segments[chain.front()].from)
    while (from + 1 < chain.size() && !corner_before(from)) ++from;
  bool other = false;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const std::size_t k = (from + i) % chain.size();
    if (i > 0 && corner_before(k)) other = !other;
    segments[chain[k]].other = other;
  }
}

/// Joins consecutive edges to chains, stores the arc length at the start of each edge, and assigns
/// border kinds to each chain. A seam is measured only along its first side, and both sides get the
/// same arc lengths.
template <class Segment>
void measure_arc_lengths(std::vector<Segment>& segments, std::span<const Vec2> places) {
  std::unordered_multimap<Index, std::size_t> by_start;
  std::unordered_map<Index, int> ends;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    by_start.emplace(segments[i].from, i);
    ++ends[segments[i].to];
  }
  std::vector<char> done(segments.size(), 0);
  const auto walk = [&](std::size_t first) {
    double along = 0;
    std::vector<std::size_t> chain;
    for (std::size_t i = first; i < segments.size();) {
      done[i] = 1;
      chain.push_back(i);
      segments[i].start = along;
      along += (places[segments[i].b] - places[segments[i].a]).norm();
      if (segments[i].twin >= 0) {
        Segment& twin = segments[static_cast<std::size_t>(segments[i].twin)];
        done[static_cast<std::size_t>(segments[i].twin)] = 1;
        std::swap(twin.a, twin.b);
        twin.start = segments[i].start;
      }
      // If several edges continue the chain, prefers those that start at the same place, that is,
      // in the same panel. Of these, takes the one with the lowest index, so that the result does
      // not depend on the order of the map.
      std::size_t next = segments.size();
      const auto [from, to] = by_start.equal_range(segments[i].to);
      const auto rank = [&](std::size_t k) { return std::pair(segments[k].a != segments[i].b, k); };
      for (auto it = from; it != to; ++it)
        if (!done[it->second] && (next == segments.size() || rank(it->second) < rank(next))) next = it->second;
      i = next;
    }
    assign_border_kinds(segments, chain, places);
  };
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!done[i] && !ends.contains(segments[i].from)) walk(i);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!done[i]) walk(i);
}

}  // namespace

/// Fills in `places_`, the positions of vertices in their flat panels. A vertex on a seam has one place for each side
/// of the seam, even if both sides belong to one panel. Returns the places of the corners of each triangle.
std::vector<Triangle> Trims::find_places(const frame::Surface& surface) {
  const auto& triangles = surface.triangles;
  const bool by_part = surface.part_of_triangle.size() == triangles.size(),
             by_corner = surface.paint_uv.size() == triangles.size();
  std::vector<Triangle> corners(triangles.size());
  places_of_.resize(surface.uv.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr double kSame = 1e-7;  // tolerance for equal places [m]
      const auto vertex = static_cast<std::size_t>(triangles[t][k]);
      const Vec2 place = by_corner ? surface.paint_uv[t][k] : surface.uv[vertex];
      const std::int32_t part = by_part ? surface.part_of_triangle[t] : 0;
      std::vector<Index>& known = places_of_[vertex];
      auto found = std::ranges::find_if(known, [&](Index each) {
        return part_[each] == part && (places_[each] - place).squaredNorm() < kSame * kSame;
      });
      if (found == known.end()) {
        found = known.insert(known.end(), static_cast<Index>(places_.size()));
        places_.push_back(place);
        part_.push_back(part);
      }
      corners[t][k] = *found;
    }
  }
  return corners;
}

Trims::Trims(const frame::Surface& surface) {
  const auto& triangles = surface.triangles;
  std::unordered_map<std::uint64_t, std::array<std::size_t, 2>> owner;  // for each directed edge: triangle and corner
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      owner.emplace(key(triangles[t][k], triangles[t][(k + 1) % 3]), std::array{t, k});
  const bool flat = !surface.uv.empty();
  const std::vector<Triangle> corners = flat ? find_places(surface) : triangles;
  std::vector<Segment> borders, seams;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = triangles[t][k], to = triangles[t][(k + 1) % 3];
      const Segment segment{corners[t][k], corners[t][(k + 1) % 3], from, to};
      const auto other = owner.find(key(to, from));
      if (other == owner.end()) {
        rims_.push_back({from, to, static_cast<std::int32_t>(t)});
        borders.push_back(segment);
        continue;
      }
      const auto [there, corner] = other->second;
      const Index a = corners[there][(corner + 1) % 3], b = corners[there][corner];
      if (t > there || (a == segment.a && b == segment.b)) continue;
      seams.push_back(segment);
      seams.push_back({b, a, to, from});
      seams[seams.size() - 2].twin = static_cast<std::int32_t>(seams.size()) - 1;
      seams.back().twin = static_cast<std::int32_t>(seams.size()) - 2;
    }
  }
  if (!flat) return;
  std::vector<std::vector<Index>> neighbors(places_.size());
  for (const Triangle& t : corners)
    for (std::size_t k = 0; k < 3; ++k) neighbors[t[k]].insert(neighbors[t[k]].end(), {t[(k + 1) % 3], t[(k + 2) % 3]});
  measure_arc_lengths(borders, places_);
  measure_arc_lengths(seams, places_);
  const auto second = std::stable_partition(borders.begin(), borders.end(), [](const Segment& s) { return !s.other; });
  lines_[Trim::other_border] = lines({second, borders.end()}, neighbors);
  borders.erase(second, borders.end());
  lines_[Trim::border] = lines(std::move(borders), neighbors);
  lines_[Trim::seam] = lines(std::move(seams), neighbors);
}

Trims::Place Trims::place(const Lines& lines, std::int32_t segment, const Vec2& at) const {
  const Segment& line = lines.segments[segment];
  const Vec2 from = places_[line.a], direction = places_[line.b] - from;
  const double length = direction.norm();
  if (!(length > 0)) return {(at - from).norm(), line.start};
  const double along = std::clamp((at - from).dot(direction) / length, 0.0, length);
  return {(at - from - along / length * direction).norm(), line.start + along};
}

/// Finds the nearest segment of each place by propagation along mesh edges. A search by position would fail, because
/// panels may overlap in the plane in which they are laid out.
Trims::Lines Trims::lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const {
  Lines result{std::move(segments), std::vector<std::int32_t>(places_.size(), -1), {}};
  result.at.resize(places_.size());
  std::vector<double> distance(places_.size(), kNoTrim);
  std::deque<Index> changed;
  const auto offer = [&](Index vertex, std::int32_t segment) {
    const double here = place(result, segment, places_[vertex]).distance;
    if (here >= distance[vertex]) return;
    distance[vertex] = here;
    result.nearest[vertex] = segment;
    changed.push_back(vertex);
  };
  for (std::size_t i = 0; i < result.segments.size(); ++i) {
    for (const Index end : {result.segments[i].a, result.segments[i].b}) {
      result.at[end].push_back(static_cast<std::int32_t>(i));
      offer(end, static_cast<std::int32_t>(i));
      for (const Index next : neighbors[end]) offer(next, static_cast<std::int32_t>(i));
    }
  }
  for (; !changed.empty(); changed.pop_front())
    for (const Index next : neighbors[changed.front()]) offer(next, result.nearest[changed.front()]);
  return result;
}

Trim Trims::trim(const Vec2& at, std::span<const Index> near) const {
  Trim result;
  for (int kind = 0; kind < Trim::kKinds; ++kind) {
    const Lines& lines = lines_[kind];
    Place best;
    const auto try_segment = [&](std::int32_t segment) {
      if (const Place here = place(lines, segment, at); here.distance < best.distance) best = here;
    };
    for (const Index vertex : near) {
      const std::int32_t nearest = lines.nearest[vertex];
      if (nearest < 0) continue;
      try_segment(nearest);
      // At a vertex of a line, two segments are equally near, but only one is stored. A point beside the vertex may be
      // closer to the segment that is not stored.
      for (const Index end : {lines.segments[nearest].a, lines.segments[nearest].b})
        std::ranges::for_each(lines.at[end], try_segment);
    }
    result.distance[kind] = static_cast<float>(best.distance);
    result.along[kind] = static_cast<float>(best.along);
  }
  return result;
}

Trim Trims::at(Index vertex) const {
  Trim nearest;
  if (places_of_.empty()) return nearest;
  for (const Index place : places_of_[vertex]) {
    const Trim here = trim(places_[place], std::span(&place, 1));
    for (int kind = 0; kind < Trim::kKinds; ++kind) {
      if (here.distance[kind] >= nearest.distance[kind]) continue;
      nearest.distance[kind] = here.distance[kind];
      nearest.along[kind] = here.along[kind];
    }
  }
  return nearest;
}

Trim Trims::middle(Index a, Index b) const {
  if (places_of_.empty()) return {};
  // Each vertex may have several places. The ends of the edge are the two closest places in the same panel.
  std::array<Index, 2> ends{places_of_[a].front(), places_of_[b].front()};
  double length = kNoTrim;
  for (const Index from : places_of_[a]) {
    for (const Index to : places_of_[b]) {
      const double here = (places_[from] - places_[to]).norm();
      if (part_[from] != part_[to] || here >= length) continue;
      length = here;
      ends = {from, to};
    }
  }
  return trim(0.5 * (places_[ends[0]] + places_[ends[1]]), ends);
}

std::vector<Slit> find_slits(const frame::Surface& surface) {
  std::vector<Slit> slits;
  if (surface.closures.empty()) return slits;
  std::unordered_map<std::uint64_t, std::int32_t> owner;  // triangle of each directed edge
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      owner.emplace(key(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]), static_cast<std::int32_t>(t));
  for (const auto& pairs : surface.closures) {
    for (std::size_t k = 1; k < pairs.size(); ++k) {
      const auto [a, b] = pairs[k - 1];
      const auto [next_a, next_b] = pairs[k];
      if (const auto found = owner.find(key(a, next_a)); found != owner.end())
        slits.push_back({{a, next_a}, {b, next_b}, found->second});
      else if (const auto reversed = owner.find(key(next_a, a)); reversed != owner.end())
        slits.push_back({{next_a, a}, {next_b, b}, reversed->second});
    }
  }
  return slits;
}

double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows) {
  const double edge = (look.hem > 0 ? 2 : 1) * look.thickness;
  if (edge <= 0) return 0;
  double nearest = 1e9;
  for (const Vec3& p : positions) nearest = std::min(nearest, view.axes.forward.dot(p - view.eye));
  const double pixel = 2 * view.tan_half_height * std::max(nearest, view.near) / rows;
  const double visibility = std::clamp(edge / pixel - 1.5, 0.0, 1.0),
               width = edge * visibility * visibility * (3 - 2 * visibility);
  return width < pixel ? 0 : width;
}

RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness) {
  RimStrip strip;
  // Per border vertex: direction away from the cloth, summed over its border edges.
  std::unordered_map<Index, Vec3> outward;
  for (const auto& [a, b, triangle] : rims) {
    const Vec3 direction = positions[b] - positions[a];
    for (const Index end : {a, b}) {
      const Vec3 out = direction.cross(normals[end]);
      const auto [entry, added] = outward.try_emplace(end, out);
      if (!added) entry->second += out;
    }
  }
  std::unordered_map<Index, Index> first;  // first of the two strip vertices of each border vertex
  const auto vertex = [&](Index v) {
    const auto [entry, added] = first.try_emplace(v, static_cast<Index>(strip.positions.size()));
    if (!added) return entry->second;
    const Vec3 sum = outward[v], out = sum.norm() > 0 ? Vec3(sum.normalized()) : normals[v];
    strip.positions.insert(strip.positions.end(), {positions[v], positions[v] - thickness * normals[v]});
    // Normals as on a rounded fold.
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
