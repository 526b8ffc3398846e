#include "collision/proximity/proximities.hpp"

#include <algorithm>
#include <cmath>

#include "collision/proximity/closest_points.hpp"

namespace weft::collision {

namespace {

/// Distances that differ by less than this part count as equal when duplicates are dropped: far above rounding, far
/// below any difference that matters.
constexpr double kTie = 1e-9;

/// Unit vector along v, or along a fallback where the two features touch and v has no direction.
Vec3 direction(const Vec3& v, const Vec3& fallback) {
  for (const Vec3& candidate : {v, fallback}) {
    const double length = candidate.stableNorm();
    if (length > 0) return candidate / length;
  }
  return Vec3::UnitZ();
}

struct FloatBox {
  Lanes4 low, high;
};

inline Lanes4 smaller(const Lanes4& a, const Lanes4& b) {
  return a < b ? a : b;
}
inline Lanes4 larger(const Lanes4& a, const Lanes4& b) {
  return a > b ? a : b;
}

/// Largest gap of two boxes along an axis; negative where they overlap.
inline bool closer_than(const FloatBox& a, const FloatBox& b, float reach) {
  const Lanes4 gap = larger(a.low - b.high, b.low - a.high);
  return std::max({gap[0], gap[1], gap[2]}) <= reach;
}

}  // namespace

/// One search: the positions and where the results go.
class ProximityFinder::Search {
 public:
  Search(const Features& features, std::span<const Vec3> x, const std::vector<Rounded>& rounded, double reach,
         float reach_rounded, std::vector<Proximity>& out)
      : features_(features), x_(x), rounded_(rounded), reach_(reach), reach_rounded_(reach_rounded), out_(out) {}

  /// All features that the two triangles own, against each other.
  void look_at(const TrianglePair& pair) {
    const Side a = side(pair.a), b = side(pair.b);
    if (!closer_than(a.box, b.box, reach_rounded_)) return;
    vertices_against_face(a, b);
    vertices_against_face(b, a);
    for (std::size_t i = 0; i < 3; ++i) {
      if ((a.owned & (8U << i)) == 0) continue;
      const FloatBox edge_a = edge_box(a, i);
      if (!closer_than(edge_a, b.box, reach_rounded_)) continue;
      for (std::size_t j = 0; j < 3; ++j)
        if ((b.owned & (8U << j)) != 0 && closer_than(edge_a, edge_box(b, j), reach_rounded_)) edges(a, i, b, j);
    }
  }

 private:
  struct Side {
    Index number;
    const Triangle& corners;
    unsigned owned;
    std::array<Lanes4, 3> at;
    FloatBox box;
  };

  Side side(Index t) const {
    const Triangle& corners = features_.triangle(t);
    const auto at = [&](std::size_t c) { return rounded_[static_cast<std::size_t>(corners[c])].xyz; };
    const Lanes4 p0 = at(0), p1 = at(1), p2 = at(2);
    return {t, corners, features_.owned(t), {p0, p1, p2}, {smaller(smaller(p0, p1), p2), larger(larger(p0, p1), p2)}};
  }

  static FloatBox edge_box(const Side& s, std::size_t i) {
    const Lanes4 p = s.at[i], q = s.at[(i + 1) % 3];
    return {smaller(p, q), larger(p, q)};
  }

  const Vec3& at(Index vertex) const { return x_[static_cast<std::size_t>(vertex)]; }

  void vertices_against_face(const Side& a, const Side& b) {
    for (std::size_t c = 0; c < 3; ++c)
      if ((a.owned & (1U << c)) != 0 && closer_than({a.at[c], a.at[c]}, b.box, reach_rounded_))
        vertex_face(a.corners[c], b.number);
  }

  void vertex_face(Index vertex, Index face) {
    const Triangle& corners = features_.triangle(face);
    if (has_vertex(corners, vertex)) return;
    const ClosestPoints points = closest_to_face(vertex, corners);
    if (!(points.distance_sq < reach_ * reach_)) return;
    if (points.support() != 0b1111U && left_out(vertex, face, points)) return;
    const Vec3 face_normal = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0]));
    add(ProximityKind::vertex_face, {vertex, corners[0], corners[1], corners[2]}, points, face_normal, {0, 0});
  }

  ClosestPoints closest_to_face(Index vertex, const Triangle& face) const {
    return closest_vertex_face(at(vertex), at(face[0]), at(face[1]), at(face[2]));
  }

  /// Whether a vertex-face pair with its closest point on the face's boundary is represented by another one.
  bool left_out(Index vertex, Index face, const ClosestPoints& points) const {
    const Triangle& corners = features_.triangle(face);
    std::array<Index, 2> support{-1, -1};  // the edge or vertex of the face where the closest point lies
    for (std::size_t c = 0, n = 0; c < 3; ++c)
      if (points.weights[c + 1] != 0 && n < 2) support[n++] = corners[c];

    // Between two vertices both sides see the same pair; the lower number is the vertex of the one listed.
    if (support[1] < 0 && vertex > support[0]) {
      const auto fan = features_.triangles_at(vertex);
      const auto apart = [&](Index t) { return !has_vertex(features_.triangle(t), support[0]); };
      if (std::any_of(fan.begin(), fan.end(), apart)) return true;
    }
    for (const Index other : features_.triangles_at(support[0])) {
      const Triangle& around = features_.triangle(other);
      const bool contains = support[1] < 0 || has_vertex(around, support[1]);
      if (other == face || !contains || has_vertex(around, vertex)) continue;
      if (other < face || closest_to_face(vertex, around).distance_sq < (1 - kTie) * points.distance_sq) return true;
    }
    return false;
  }

  void edges(const Side& a, std::size_t i, const Side& b, std::size_t j) {
    const std::array<Index, 4> v{a.corners[i], a.corners[(i + 1) % 3], b.corners[j], b.corners[(j + 1) % 3]};
    if (v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3]) return;
    const ClosestPoints points = closest_edge_edge(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
    // With an end as closest point the vertex and the faces at the other edge represent the pair.
    if (!(points.distance_sq < reach_ * reach_) || points.support() != 0b1111U) return;
    const Vec3 across = (at(v[1]) - at(v[0])).cross(at(v[3]) - at(v[2]));
    const Vec3 normal = direction(points.difference, across);
    add(ProximityKind::edge_edge, v, points, across,
        {outside_wedge(v[0], v[1], -normal), outside_wedge(v[2], v[3], normal)});
  }

  /// Largest sine by which going from the edge in the unit direction `outward` has a part into one of its faces.
  double outside_wedge(Index e0, Index e1, const Vec3& outward) const {
    const Vec3 along = direction(at(e1) - at(e0), Vec3::Zero());
    double most = -1;
    for (const Index t : features_.triangles_at(e0)) {
      const Triangle& face = features_.triangle(t);
      if (!has_vertex(face, e1)) continue;
      for (const Index corner : face) {
        if (corner == e0 || corner == e1) continue;
        const Vec3 arm = at(corner) - at(e0);
        const Vec3 inward = direction(arm - along * along.dot(arm), Vec3::Zero());
        most = std::max(most, inward.dot(outward));
      }
    }
    return most;
  }

  void add(ProximityKind kind, const std::array<Index, 4>& vertices, const ClosestPoints& points, const Vec3& fallback,
           const std::array<double, 2>& outside) {
    out_.push_back({kind, vertices, points.weights, direction(points.difference, fallback),
                    std::sqrt(points.distance_sq), outside});
  }

  const Features& features_;
  std::span<const Vec3> x_;
  const std::vector<Rounded>& rounded_;
  const double reach_;
  const float reach_rounded_;
  std::vector<Proximity>& out_;
};

void ProximityFinder::find(const CandidatePairs& candidates, std::span<const Surface> deformable,
                           std::span<const Vec3> x, double reach, std::vector<Proximity>& out) {
  out.clear();
  // First look in float. Rounding moves a coordinate by 2^-24 of itself, so a gap of two by four times that at most.
  double largest = 0;
  rounded_.resize(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) {
    largest = std::max(largest, x[v].cwiseAbs().maxCoeff());
    rounded_[v].xyz =
        Lanes4{static_cast<float>(x[v][0]), static_cast<float>(x[v][1]), static_cast<float>(x[v][2]), 0.0F};
  }
  const auto reach_rounded = static_cast<float>(reach * (1 + 1e-6) + largest * 0x1p-21 + 1e-37);

  Search search(features_, x, rounded_, reach, reach_rounded, out);
  for (const TrianglePair& pair : candidates.apart) search.look_at(pair);
  for (const TrianglePair& pair : candidates.one_shared) search.look_at(pair);
  for (const Surface& surface : deformable)
    for (const TrianglePair& pair :
         features_.hinges(surface.first_triangle, static_cast<Index>(surface.triangles.size())))
      search.look_at(pair);
}

}  // namespace weft::collision
