#include "physics/collision/response/vertex_stars.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

/// The triangle with its corners rotated so that `first` comes first. For a piece of rope, `first`
/// appears only once in the result, and the other end twice.
Triangle rotate_to_front(const Triangle& t, Index first) {
  if (t[1] == t[2]) return t[0] == first ? t : Triangle{first, t[0], t[0]};
  return t[0] == first ? t : t[1] == first ? Triangle{t[1], t[2], t[0]} : Triangle{t[2], t[0], t[1]};
}

/// Whether two edges share an end.
bool share_end(const std::array<Index, 2>& s, const std::array<Index, 2>& t) {
  return s[0] == t[0] || s[0] == t[1] || s[1] == t[0] || s[1] == t[1];
}

/// Largest distance d that each corner of a triangle may move while n·(e × f), now `area`, stays positive for edges e
/// and f taken at any two times; −1 if area <= 0. `lengths`: |e| + |f| now. Each edge changes by at most 2 d, so the
/// product changes by at most 2 d (|e| + |f|) + 4 d².
double allowed_motion(double area, double lengths) {
  return area > 0 ? 0.25 * (std::sqrt(lengths * lengths + 4 * area) - lengths) : -1;
}

}  // namespace

VertexStars::VertexStars(std::span<const Surface> surfaces) {
  for (const Surface& surface : surfaces) {
    // List the triangles at each vertex (counting sort), in their order.
    std::vector<std::uint32_t> begin(static_cast<std::size_t>(surface.vertex_count) + 1, 0);
    const auto place = [&](Index v) -> std::uint32_t& {
      return begin[static_cast<std::size_t>(v - surface.first_vertex)];
    };
    const auto corners_of = [](const Triangle& t) { return std::span(t).first(t[1] == t[2] ? 2 : 3); };
    for (const Triangle& t : surface.triangles)
      for (Index v : corners_of(t)) ++place(v);
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::uint32_t{0});
    std::vector<Triangle> rotated(begin.back());
    for (const Triangle& t : surface.triangles)
      for (Index v : corners_of(t)) rotated[place(v)++] = rotate_to_front(t, v);
    std::uint32_t first = 0;  // place(v) now is the end of the range of v
    for (Index v = surface.first_vertex; v < surface.first_vertex + surface.vertex_count; ++v) {
      add_star(v, std::span(rotated).subspan(first, place(v) - first));
      first = place(v);
    }
  }
  for (auto* numbers : {&centres_, &ring_vertices_}) numbers->shrink_to_fit();
  measures_.assign(centres_.size(), {-1, -1});
  is_separated_.assign(centres_.size(), 0);
}

void VertexStars::add_star(Index vertex, std::span<const Triangle> triangles) {
  // Go from triangle to triangle over common edges. In a closed star, this returns to the first triangle after all of
  // them. Any other star is stored without a ring and tested pair by pair, or not stored if it has no pair to test.
  std::vector<Index> ring{triangles.empty() ? vertex : triangles.front()[1]};
  while (ring.size() <= triangles.size() && !triangles.empty()) {
    const auto next =
        std::find_if(triangles.begin(), triangles.end(), [&](const Triangle& t) { return t[1] == ring.back(); });
    if (next == triangles.end()) break;
    ring.push_back((*next)[2]);
    if (ring.back() == ring.front()) break;
  }
  const bool closed = ring.size() == triangles.size() + 1 && ring.size() > 3 && ring.back() == ring.front();
  const auto touches_all = [&](const Triangle& s) {
    return std::ranges::all_of(triangles, [&](const Triangle& t) { return share_end({s[1], s[2]}, {t[1], t[2]}); });
  };
  if (!closed && std::ranges::all_of(triangles, touches_all)) return;
  centres_.push_back(vertex);
  closed_.push_back(closed ? 1 : 0);
  if (closed)
    ring_vertices_.insert(ring_vertices_.end(), ring.begin(), ring.end());
  else
    for (const Triangle& t : triangles) ring_vertices_.insert(ring_vertices_.end(), {t[1], t[2]});
  begin_.push_back(static_cast<std::uint32_t>(ring_vertices_.size()));
}

// Calls body(pair) for each edge opposite to the centre and each triangle of the star that has no vertex of this edge.
template <class Body>
void VertexStars::for_each_pair(std::size_t star, const Body& body) const {
  for (std::size_t k = 0; k < edge_count(star); ++k)
    for (std::size_t l = 0; l < edge_count(star); ++l)
      if (const Edge s = edge(star, k), t = edge(star, l); !share_end(s, t))
        body(CornerPair{{s[0], s[1], s[1]}, {centres_[star], t[0], t[1]}});
}

// Whether the star goes around its centre once. Its triangles must all be positively oriented along the axis. Compares
// the directions to the ring vertices with the first one: their cross product changes from negative to positive once
// per turn.
bool VertexStars::turns_once(std::size_t star, const Vec3& axis, std::span<const Vec3> x) const {
  const auto vertices = ring(star);
  const Vec3& centre = x[centres_[star]];
  const Vec3 across = axis.cross(x[vertices.front()] - centre);
  int turns = 0;
  double before = 0;
  for (std::size_t k = 1; k + 1 < vertices.size(); ++k) {
    const double side = across.dot(x[vertices[k]] - centre);
    turns += before < 0 && side >= 0 ? 1 : 0;
    before = side;
  }
  return turns + (before < 0 ? 1 : 0) == 1;
}

void VertexStars::forget_tests() {
  is_separated_.assign(centres_.size(), 0);
}

void VertexStars::set_reference(std::span<const Vec3> x) {
  forget_tests();
  parallel_for(centres_.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t star = begin; star < end; ++star) measures_[star] = measure_star(star, x);
  });
}

VertexStars::StarMeasures VertexStars::measure_star(std::size_t star, std::span<const Vec3> x) const {
  constexpr StarMeasures kNone{-1, -1};
  const auto vertices = ring(star);
  if (vertices.empty()) return kNone;
  const Vec3& centre = x[centres_[star]];
  Vec3 axis = Vec3::Zero(), e = x[vertices.front()] - centre;
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f = x[vertices[k]] - centre;
    axis += e.cross(f);
    e = f;
  }
  axis.normalize();
  double slack = std::numeric_limits<double>::infinity(), clearance = slack, e_length = e.norm();
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f = x[vertices[k]] - centre;
    const double f_length = f.norm(), area = axis.dot(e.cross(f));
    slack = std::min(slack, allowed_motion(area, e_length + f_length));
    clearance = std::min(clearance, area / std::max({e_length, f_length, (f - e).norm()}));
    e = f;
    e_length = f_length;
  }
  // The factor 0.999 covers all rounding.
  if (!(slack > 0) || !turns_once(star, axis, x)) return kNone;
  return {static_cast<float>(0.999 * slack), static_cast<float>(0.999 * clearance)};
}

void VertexStars::mark_clear(double distance, std::span<const Vec3> x, std::span<std::uint8_t> vertices) const {
  parallel_for(centres_.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t star = begin; star < end; ++star) {
      const StarMeasures measures = x.empty() ? measures_[star] : measure_star(star, x);
      if (static_cast<double>(measures.clearance) > distance) vertices[centres_[star]] = 1;
    }
  });
}

bool VertexStars::keeps_orientation(std::size_t star, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const {
  const auto vertices = ring(star);
  if (vertices.empty()) return false;
  const auto arm = [&](std::size_t k, std::span<const Vec3> x) -> Vec3 { return x[vertices[k]] - x[centres_[star]]; };
  Vec3 axis = Vec3::Zero(), e_t0 = arm(0, x_t0), e_t1 = arm(0, x_t1);
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f_t0 = arm(k, x_t0), f_t1 = arm(k, x_t1);
    axis += e_t0.cross(f_t0) + e_t1.cross(f_t1);
    e_t0 = f_t0;
    e_t1 = f_t1;
  }
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f_t0 = arm(k, x_t0), f_t1 = arm(k, x_t1);
    // `least` is far above the rounding errors of these products, and far below their values at angles that occur.
    const double least = 1e-9 * axis.norm() * (e_t0.norm() + e_t1.norm()) * (f_t0.norm() + f_t1.norm());
    if (axis.dot(e_t0.cross(f_t0)) <= least || axis.dot(e_t1.cross(f_t1)) <= least ||
        axis.dot(e_t0.cross(f_t1) + e_t1.cross(f_t0)) <= least)
      return false;
    e_t0 = f_t0;
    e_t1 = f_t1;
  }
  return turns_once(star, axis, x_t0);
}

void VertexStars::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                               std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing,
                               PlaneKinds which) {
  const auto any_changed = [&](std::size_t star) {
    return changed[centres_[star]] ||
           std::ranges::any_of(other_vertices(star), [&](Index v) { return changed[v] != 0; });
  };
  const auto stays = [&](std::size_t star) {
    const float slack = measures_[star].slack;
    if (!(slack > 0)) return false;
    float max_moved = moved[centres_[star]];
    for (Index v : ring(star)) max_moved = std::max(max_moved, moved[v]);
    return max_moved < slack;
  };
  parallel_append(centres_.size(), kFineGrainSize, failing, [&](std::size_t begin, std::size_t end, auto& list) {
    for (std::size_t star = begin; star < end; ++star) {
      if (is_separated_[star] && !any_changed(star)) continue;
      is_separated_[star] = 1;
      if (stays(star) || keeps_orientation(star, x_t0, x_t1)) continue;
      for_each_pair(star, [&](const CornerPair& pair) {
        if (find_separating_plane(pair, x_t0, x_t1, which)) return;
        is_separated_[star] = 0;
        list.push_back(pair);
      });
    }
  });
}

}  // namespace weft::collision
