#include "collision/response/fans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel_append.hpp"

namespace weft::collision {
namespace {

/// The triangle with its corners turned so that `first` comes first; of a piece of rope, whose other corners are one,
/// `first` comes once.
Triangle turned(const Triangle& t, Index first) {
  if (t[1] == t[2]) return t[0] == first ? t : Triangle{first, t[0], t[0]};
  return t[0] == first ? t : t[1] == first ? Triangle{t[1], t[2], t[0]} : Triangle{t[2], t[0], t[1]};
}

/// Whether two edges have an end in common.
bool touch(const std::array<Index, 2>& s, const std::array<Index, 2>& t) {
  return s[0] == t[0] || s[0] == t[1] || s[1] == t[0] || s[1] == t[1];
}

/// The largest distance d that all three corners of a triangle at a vertex may move so that its oriented area, `area`
/// now, stays positive, also in the products of one edge at one time and the other at another: each edge changes by 2 d
/// at most, the product by 2 d (|e| + |f|) + 4 d².
double room(double area, double lengths) {
  return area > 0 ? 0.25 * (std::sqrt(lengths * lengths + 4 * area) - lengths) : -1;
}

}  // namespace

Fans::Fans(std::span<const Surface> surfaces) {
  for (const Surface& surface : surfaces) {
    // Triangles by vertex, in their order.
    std::vector<std::uint32_t> begin(static_cast<std::size_t>(surface.vertex_count) + 1, 0);
    const auto place = [&](Index v) -> std::uint32_t& {
      return begin[static_cast<std::size_t>(v - surface.first_vertex)];
    };
    const auto corners_of = [](const Triangle& t) { return std::span(t).first(t[1] == t[2] ? 2 : 3); };
    for (const Triangle& t : surface.triangles)
      for (Index v : corners_of(t)) ++place(v);
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::uint32_t{0});
    std::vector<Triangle> turned_to(begin.back());
    for (const Triangle& t : surface.triangles)
      for (Index v : corners_of(t)) turned_to[place(v)++] = turned(t, v);
    std::uint32_t first = 0;  // places are now those of the ends
    for (Index v = surface.first_vertex; v < surface.first_vertex + surface.vertex_count; ++v) {
      add_fan(v, std::span(turned_to).subspan(first, place(v) - first));
      first = place(v);
    }
  }
  for (auto* numbers : {&middle_, &around_}) numbers->shrink_to_fit();
  rooms_.assign(middle_.size(), {-1, -1});
  has_certificate_.assign(middle_.size(), 0);
}

void Fans::add_fan(Index vertex, std::span<const Triangle> triangles) {
  // From triangle to triangle over the edges they share: a closed fan comes back after all of them. Any other set of
  // triangles is kept as a fan without a ring, which is always taken pair by pair.
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
    return std::ranges::all_of(triangles, [&](const Triangle& t) { return touch({s[1], s[2]}, {t[1], t[2]}); });
  };
  if (!closed && std::ranges::all_of(triangles, touches_all)) return;
  middle_.push_back(vertex);
  closed_.push_back(closed ? 1 : 0);
  if (closed)
    around_.insert(around_.end(), ring.begin(), ring.end());
  else
    for (const Triangle& t : triangles) around_.insert(around_.end(), {t[1], t[2]});
  begin_.push_back(static_cast<std::uint32_t>(around_.size()));
}

// Calls body(pair) for all pairs of an edge opposite to the vertex and another triangle of the fan.
template <class Body>
void Fans::for_each_pair(std::size_t fan, const Body& body) const {
  for (std::size_t k = 0; k < edge_count(fan); ++k)
    for (std::size_t l = 0; l < edge_count(fan); ++l)
      if (const Edge s = edge(fan, k), t = edge(fan, l); !touch(s, t))
        body(CornerPair{{s[0], s[1], s[1]}, {middle_[fan], t[0], t[1]}});
}

// Whether the fan, all of whose triangles are positively oriented along the axis, goes around once: of the directions
// to its ring, measured from the first, the cross product turns from negative to positive once for each turn.
bool Fans::turns_once(std::size_t fan, const Vec3& axis, std::span<const Vec3> x) const {
  const auto vertices = ring(fan);
  const Vec3& middle = x[middle_[fan]];
  const Vec3 across = axis.cross(x[vertices.front()] - middle);
  int turns = 0;
  double before = 0;
  for (std::size_t k = 1; k + 1 < vertices.size(); ++k) {
    const double side = across.dot(x[vertices[k]] - middle);
    turns += before < 0 && side >= 0 ? 1 : 0;
    before = side;
  }
  return turns + (before < 0 ? 1 : 0) == 1;
}

void Fans::set_reference(std::span<const Vec3> x) {
  has_certificate_.assign(middle_.size(), 0);
  parallel_for(middle_.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t fan = begin; fan < end; ++fan) rooms_[fan] = room_of(fan, x);
  });
}

Fans::Room Fans::room_of(std::size_t fan, std::span<const Vec3> x) const {
  constexpr Room kNone{-1, -1};
  const auto vertices = ring(fan);
  if (vertices.empty()) return kNone;
  const Vec3& middle = x[middle_[fan]];
  Vec3 axis = Vec3::Zero(), e = x[vertices.front()] - middle;
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f = x[vertices[k]] - middle;
    axis += e.cross(f);
    e = f;
  }
  axis.normalize();
  double slack = std::numeric_limits<double>::infinity(), clearance = slack, e_length = e.norm();
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f = x[vertices[k]] - middle;
    const double f_length = f.norm(), area = axis.dot(e.cross(f));
    slack = std::min(slack, room(area, e_length + f_length));
    clearance = std::min(clearance, area / std::max({e_length, f_length, (f - e).norm()}));
    e = f;
    e_length = f_length;
  }
  // A thousandth less than it is covers all rounding.
  if (!(slack > 0) || !turns_once(fan, axis, x)) return kNone;
  return {static_cast<float>(0.999 * slack), static_cast<float>(0.999 * clearance)};
}

void Fans::mark_open(double distance, std::span<const Vec3> x, std::span<std::uint8_t> vertices) const {
  parallel_for(middle_.size(), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t fan = begin; fan < end; ++fan)
      if (static_cast<double>(room_of(fan, x).clearance) > distance) vertices[middle_[fan]] = 1;
  });
}

bool Fans::keeps_orientation(std::size_t fan, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const {
  const auto vertices = ring(fan);
  if (vertices.empty()) return false;
  const auto arm = [&](std::size_t k, std::span<const Vec3> x) -> Vec3 { return x[vertices[k]] - x[middle_[fan]]; };
  Vec3 axis = Vec3::Zero(), e_t0 = arm(0, x_t0), e_t1 = arm(0, x_t1);
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f_t0 = arm(k, x_t0), f_t1 = arm(k, x_t1);
    axis += e_t0.cross(f_t0) + e_t1.cross(f_t1);
    e_t0 = f_t0;
    e_t1 = f_t1;
  }
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const Vec3 f_t0 = arm(k, x_t0), f_t1 = arm(k, x_t1);
    // Far above the rounding of these products, far below any angle that matters.
    const double least = 1e-9 * axis.norm() * (e_t0.norm() + e_t1.norm()) * (f_t0.norm() + f_t1.norm());
    if (axis.dot(e_t0.cross(f_t0)) <= least || axis.dot(e_t1.cross(f_t1)) <= least ||
        axis.dot(e_t0.cross(f_t1) + e_t1.cross(f_t0)) <= least)
      return false;
    e_t0 = f_t0;
    e_t1 = f_t1;
  }
  return turns_once(fan, axis, x_t0);
}

void Fans::find_failing(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const float> moved,
                        std::span<const std::uint8_t> changed, std::vector<CornerPair>& failing, Certificates which) {
  const auto any_changed = [&](std::size_t fan) {
    return changed[middle_[fan]] || std::ranges::any_of(around(fan), [&](Index v) { return changed[v] != 0; });
  };
  const auto stays = [&](std::size_t fan) {
    const float slack = rooms_[fan].slack;
    if (!(slack > 0)) return false;
    float most = moved[middle_[fan]];
    for (Index v : ring(fan)) most = std::max(most, moved[v]);
    return most < slack;
  };
  parallel_append(middle_.size(), kFineGrainSize, failing, [&](std::size_t begin, std::size_t end, auto& list) {
    for (std::size_t fan = begin; fan < end; ++fan) {
      if (has_certificate_[fan] && !any_changed(fan)) continue;
      has_certificate_[fan] = 1;
      if (stays(fan) || keeps_orientation(fan, x_t0, x_t1)) continue;
      for_each_pair(fan, [&](const CornerPair& pair) {
        if (find_certificate(pair, x_t0, x_t1, which)) return;
        has_certificate_[fan] = 0;
        list.push_back(pair);
      });
    }
  });
}

}  // namespace weft::collision
