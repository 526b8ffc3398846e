#include "physics/collision/proximity/proximities.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "core/parallel_append.hpp"
#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {

namespace {

// Number of triangles whose pairs with a common vertex form one batch. Each triangle has six to nine such pairs.
constexpr std::size_t kTrianglesPerBatch = 64;
// Number of listed pairs per call of AppendPairs.
constexpr std::size_t kPairsPerBatch = 4 * kGrainSize;

/// Unit vector along v. If v is zero because the features touch: unit vector along `fallback`; if `fallback` is also
/// zero: along z.
Vec3 direction(const Vec3& v, const Vec3& fallback) {
  if (const double length_sq = v.squaredNorm(); length_sq > 1e-280) return v / std::sqrt(length_sq);
  for (const Vec3& tiny : {v, fallback}) {
    const double length = tiny.stableNorm();
    if (length > 0) return tiny / length;
  }
  return Vec3::UnitZ();
}

}  // namespace

struct ProximityFinder::GatherParameters {
  std::span<const Vec3> x;
  double radius;
  float radius_rounded;
  double min_fold;
};

/// Finds the pairs of features that may be closer than a radius, among those of given pairs of
/// triangles.
class ProximityFinder::Gathering {
 public:
  Gathering(const ProximityFinder& finder, const GatherParameters& parameters, FeaturePairs& found)
      : finder_(finder),
        found_(found),
        features_(finder.features_),
        rounded_(finder.rounded_),
        x_(parameters.x),
        radius_sq_(parameters.radius * parameters.radius),
        radius_rounded_(parameters.radius_rounded),
        min_fold_(static_cast<float>(parameters.min_fold)) {}

  /// Tests all owned features of each pair of triangles against each other. Tests their boxes first, for eight pairs at
  /// once and without branches, whose mispredictions would triple the time of the box tests.
  void test_pairs(std::span<const TrianglePair> pairs) {
    for (; pairs.size() >= 8; pairs = pairs.subspan(8)) test_eight_pairs(pairs.first<8>(), 8);
    if (pairs.empty()) return;
    std::array<TrianglePair, 8> rest;
    std::copy(pairs.begin(), pairs.end(), rest.begin());
    std::fill(rest.begin() + static_cast<std::ptrdiff_t>(pairs.size()), rest.end(), pairs.front());
    test_eight_pairs(rest, pairs.size());
  }

 private:
  struct Boxes {
    Points8 low, high;
  };

  /// One side of eight pairs of triangles.
  struct Side {
    std::array<Points8, 3> at;  // by corner
    std::array<Boxes, 3> edge;  // edge i goes from corner i to corner i + 1
    Boxes face;
    std::array<IntLanes8, 3> corner;     // vertex numbers
    std::array<std::uint32_t, 6> owned;  // by corner, then by edge; bit l: the triangle in lane l owns it

    Side(const Features& features, const std::vector<Rounded>& rounded, const std::array<Index, 8>& triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Lanes4* row[8];
        for (std::size_t l = 0; l < 8; ++l) {
          corner[c][l] = features.triangle(triangles[l])[c];
          row[l] = &rounded[corner[c][l]].xyz;
        }
        at[c] = transpose(row);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) {
          Lanes8 &low = edge[i].low.axis[axis] = at[i].axis[axis], &high = edge[i].high.axis[axis] = at[i].axis[axis];
          lower_to(low, at[(i + 1) % 3].axis[axis]);
          raise_to(high, at[(i + 1) % 3].axis[axis]);
        }
        face.low.axis[axis] = edge[0].low.axis[axis];
        face.high.axis[axis] = edge[0].high.axis[axis];
        lower_to(face.low.axis[axis], edge[1].low.axis[axis]);
        raise_to(face.high.axis[axis], edge[1].high.axis[axis]);
      }
      IntLanes8 bits;
      for (std::size_t l = 0; l < 8; ++l) bits[l] = features.owned(triangles[l]);
      for (int bit = 0; bit < 6; ++bit) owned[bit] = sign_mask(IntLanes8(bits << (31 - bit)));
    }
  };

  /// Bit l is set if the boxes in lane l are closer than the radius along every axis.
  static std::uint32_t near(const Points8& a_low, const Points8& a_high, const Boxes& b, const Lanes8& radius) {
    Lanes8 gap = a_low.axis[0] - b.high.axis[0];
    raise_to(gap, b.low.axis[0] - a_high.axis[0]);
    for (std::size_t axis = 1; axis < 3; ++axis) {
      raise_to(gap, a_low.axis[axis] - b.high.axis[axis]);
      raise_to(gap, b.low.axis[axis] - a_high.axis[axis]);
    }
    return sign_mask(gap - radius);
  }

  /// The radius for the box tests in float. Rounding changes a gap between two coordinates by less
  /// than four times 2^-24 of the largest coordinate. Uses only coordinates of the pair, so other
  /// bodies do not affect the result.
  Lanes8 rounded_radius(const Boxes& a, const Boxes& b) const {
    Lanes8 largest = a.high.axis[0];
    for (const Boxes* box : {&a, &b})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        raise_to(largest, box->high.axis[axis]);
        raise_to(largest, -box->low.axis[axis]);
      }
    return radius_rounded_ + largest * 0x1p-21F;
  }

  void test_eight_pairs(std::span<const TrianglePair, 8> pairs, std::size_t count) {
    std::array<Index, 8> number_a, number_b;
    for (std::size_t l = 0; l < 8; ++l) number_a[l] = pairs[l].a, number_b[l] = pairs[l].b;
    const Side a(features_, rounded_, number_a), b(features_, rounded_, number_b);
    const Lanes8 radius = rounded_radius(a.face, b.face);
    const std::uint32_t together = near(a.face.low, a.face.high, b.face, radius) & ((1U << count) - 1);
    if (together == 0) return;
    std::array<std::array<std::uint32_t, 3>, 3> same;  // bit l: corner i of a is corner j of b
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) same[i][j] = sign_mask(IntLanes8(a.corner[i] == b.corner[j]));

    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a_in_b = same[c][0] | same[c][1] | same[c][2], b_in_a = same[0][c] | same[1][c] | same[2][c];
      for_each_bit(near(a.at[c], a.at[c], b.face, radius) & a.owned[c] & together & ~a_in_b,
                   [&](std::size_t l) { keep_vertex_face(a.corner[c][l], number_b[l]); });
      for_each_bit(near(b.at[c], b.at[c], a.face, radius) & b.owned[c] & together & ~b_in_a,
                   [&](std::size_t l) { keep_vertex_face(b.corner[c][l], number_a[l]); });
    }
    for (std::size_t i = 0, i1 = 1; i < 3; ++i, i1 = (i + 1) % 3) {
      for (std::size_t j = 0, j1 = 1; j < 3; ++j, j1 = (j + 1) % 3) {
        const std::uint32_t common = same[i][j] | same[i][j1] | same[i1][j] | same[i1][j1];
        const std::uint32_t near_pairs = near(a.edge[i].low, a.edge[i].high, b.edge[j], radius) & together & ~common;
        for_each_bit(near_pairs & a.owned[3 + i] & b.owned[3 + j], [&](std::size_t l) {
          EdgeEdge edges{number_a[l], number_b[l], static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)};
          if (edges.face_a > edges.face_b) edges = {edges.face_b, edges.face_a, edges.edge_b, edges.edge_a};
          keep_edges(edges, {a.corner[i][l], a.corner[i1][l], b.corner[j][l], b.corner[j1][l]});
        });
      }
    }
  }

  const Vec3& at(Index vertex) const { return x_[vertex]; }

  void keep_vertex_face(Index vertex, Index face) {
    const Triangle& corners = features_.triangle(face);
    if (!is_surely_farther(at(vertex), at(corners[0]), at(corners[1]), at(corners[2]), radius_sq_))
      found_.vertex_faces.push_back({vertex, face});
  }

  void keep_edges(const EdgeEdge& edges, const std::array<Index, 4>& v) {
    if (min_fold_ > 0 && fold(edges.face_a, edges.edge_a) + fold(edges.face_b, edges.edge_b) < min_fold_) return;
    if (!are_edges_surely_farther(at(v[0]), at(v[1]), at(v[2]), at(v[3]), radius_sq_))
      found_.edge_edges.push_back(edges);
  }

  float fold(Index face, std::size_t edge) const { return finder_.folds_[face][edge]; }

  const ProximityFinder& finder_;
  FeaturePairs& found_;
  const Features& features_;
  const std::vector<Rounded>& rounded_;
  std::span<const Vec3> x_;
  const double radius_sq_;
  const float radius_rounded_;
  const float min_fold_;
};

/// Finds the near pairs among pairs of features.
class ProximityFinder::Search {
 public:
  Search(const Features& features, std::span<const Vec3> x, double detection_distance, std::vector<Proximity>& out)
      : features_(features), x_(x), detection_distance_sq_(detection_distance * detection_distance), out_(out) {}

  void vertex_face(Index vertex, Index face) {
    const Triangle& corners = features_.triangle(face);
    if (is_surely_farther(at(vertex), at(corners[0]), at(corners[1]), at(corners[2]), detection_distance_sq_)) return;
    const ClosestPoints points = closest_to_face(vertex, corners);
    if (!(points.distance_sq < detection_distance_sq_)) return;
    if (points.support() != 0b1111U && is_represented_by_other(vertex, face, points)) return;
    const Vec3 face_normal = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0]));
    const double outside = points.support() == 0b1111U ? 0 : outside_vertex_wedge(vertex, points);
    add(ProximityKind::vertex_face, {vertex, corners[0], corners[1], corners[2]}, points, face_normal, {outside, 0});
  }

  ClosestPoints closest_to_face(Index vertex, const Triangle& face) const {
    return closest_vertex_face(at(vertex), at(face[0]), at(face[1]), at(face[2]));
  }

  /// Whether another pair represents this one, whose closest point is on the boundary of the face (see
  /// ProximityFinder).
  bool is_represented_by_other(Index vertex, Index face, const ClosestPoints& points) const {
    const Triangle& corners = features_.triangle(face);
    std::array<Index, 2> support{-1, -1};  // ends of the edge, or vertex, of the face on which the closest point lies
    for (std::size_t c = 0, n = 0; c < 3; ++c)
      if (points.weights[c + 1] != 0 && n < 2) support[n++] = corners[c];

    // If the closest points are two vertices, list only the pair of the lower-numbered vertex with
    // a face around the other.
    if (support[1] < 0 && vertex > support[0]) {
      const auto star = features_.triangles_at(vertex);
      const auto apart = [&](Index t) { return !has_vertex(features_.triangle(t), support[0]); };
      if (std::any_of(star.begin(), star.end(), apart)) return true;
    }
    for (const Index other : features_.triangles_at(support[0])) {
      const Triangle& around = features_.triangle(other);
      const bool contains = support[1] < 0 || has_vertex(around, support[1]);
      if (other == face || !contains || has_vertex(around, vertex)) continue;
      if (other < face || closest_to_face(vertex, around).distance_sq < (1 - kRoundoff) * points.distance_sq)
        return true;
    }
    return false;
  }

  void edges(const EdgeEdge& pair) {
    const Triangle &a = features_.triangle(pair.face_a), &b = features_.triangle(pair.face_b);
    const std::array<Index, 4> v{a[pair.edge_a], a[(pair.edge_a + 1) % 3], b[pair.edge_b], b[(pair.edge_b + 1) % 3]};
    if (is_surely_not_interior(at(v[0]), at(v[1]), at(v[2]), at(v[3]), detection_distance_sq_)) return;
    const ClosestPoints points = closest_edge_edge(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
    // If a closest point is the end of an edge, that vertex and the faces at the other edge represent the pair.
    if (!(points.distance_sq < detection_distance_sq_) || points.support() != 0b1111U) return;
    const Vec3 across = (at(v[1]) - at(v[0])).cross(at(v[3]) - at(v[2]));
    const Vec3 normal = direction(points.difference, across);
    add(ProximityKind::edge_edge, v, points, across,
        {outside_wedge(v[0], v[1], features_.apexes(pair.face_a, pair.edge_a), -normal),
         outside_wedge(v[2], v[3], features_.apexes(pair.face_b, pair.edge_b), normal)});
  }

 private:
  const Vec3& at(Index vertex) const { return x_[vertex]; }

  /// Largest sine of the angle by which `outward`, a unit vector perpendicular to the edge, points towards a face at
  /// the edge: |edge| (arm · outward) / |edge × arm|. `apexes`: corners of the faces opposite to the edge.
  double outside_wedge(Index e0, Index e1, std::span<const Index> apexes, const Vec3& outward) const {
    const Vec3 edge = at(e1) - at(e0);
    const double length = edge.norm();
    double max_sine = -1;
    for (const Index apex : apexes) {
      const Vec3 arm = at(apex) - at(e0);
      const double across = edge.cross(arm).norm();
      if (across > 0) max_sine = std::max(max_sine, length * arm.dot(outward) / across);
    }
    return max_sine;
  }

  /// Sine of the angle from the wedge of a vertex (see Proximity) to the direction towards its
  /// closest point; 0 if this direction is inside the wedge.
  double outside_vertex_wedge(Index vertex, const ClosestPoints& points) const {
    const Vec3 point = at(vertex) - points.difference;
    double least_sq = (1 - kRoundoff) * points.distance_sq;
    bool is_inside = true;
    for (const Index t : features_.triangles_at(vertex)) {
      const Triangle& face = features_.triangle(t);
      const double distance_sq = closest_vertex_face(point, at(face[0]), at(face[1]), at(face[2])).distance_sq;
      if (distance_sq < least_sq) least_sq = distance_sq, is_inside = false;
    }
    return is_inside ? 0 : std::sqrt(1 - least_sq / points.distance_sq);
  }

  void add(ProximityKind kind, const std::array<Index, 4>& vertices, const ClosestPoints& points, const Vec3& fallback,
           const std::array<double, 2>& outside) {
    out_.push_back(
        {{vertices, points.weights, direction(points.difference, fallback), std::sqrt(points.distance_sq), kind},
         outside});
  }

  const Features& features_;
  std::span<const Vec3> x_;
  const double detection_distance_sq_;
  std::vector<Proximity>& out_;
};

void ProximityFinder::measure_folds(std::span<const Vec3> x) {
  const auto triangles = features_.triangles();
  const auto at = [&](Index vertex) -> const Vec3& { return x[vertex]; };
  std::vector<Vec3> normals(triangles.size());
  folds_.resize(triangles.size());
  parallel_for(triangles.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      normals[t] =
          (at(triangles[t][1]) - at(triangles[t][0])).cross(at(triangles[t][2]) - at(triangles[t][0])).normalized();
  });
  // The sine of half the fold angle θ follows from 1 − cos θ = 2 sin² (θ / 2). Edges that are not shared by exactly two
  // triangles get the value 1.
  const auto fold = [&](std::size_t t, Index other) {
    return static_cast<float>(std::sqrt(std::max(0.0, 0.5 - 0.5 * normals[t].dot(normals[other]))));
  };
  parallel_for(triangles.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Index other = features_.across(static_cast<Index>(t), c);
        folds_[t][c] = other < 0 ? 1.0F : fold(t, other);
      }
  });
}

ProximityFinder::GatherParameters ProximityFinder::begin_gathering(std::span<const Vec3> x, double radius,
                                                                   double min_fold) {
  if (min_fold > 0) measure_folds(x);
  // Round positions to float for the box tests.
  rounded_.resize(x.size());
  parallel_for(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      rounded_[v].xyz =
          Lanes4{static_cast<float>(x[v][0]), static_cast<float>(x[v][1]), static_cast<float>(x[v][2]), 0.0F};
  });
  pairs_.vertex_faces.clear();
  pairs_.edge_edges.clear();
  return {x, radius, static_cast<float>(radius * (1 + 1e-6) + 1e-37), min_fold};
}

void ProximityFinder::test_pairs(std::span<const TrianglePair> pairs, const GatherParameters& parameters) {
  parallel_append(pairs.size(), kGrainSize, pairs_, [&](std::size_t begin, std::size_t end, FeaturePairs& found) {
    Gathering(*this, parameters, found).test_pairs(pairs.subspan(begin, end - begin));
  });
}

void ProximityFinder::gather(const CandidatePairs& candidates, std::span<const Surface> deformable,
                             std::span<const Vec3> x, double radius, double min_fold) {
  const GatherParameters parameters = begin_gathering(x, radius, min_fold);
  test_pairs(candidates.apart.view(), parameters);
  test_pairs(candidates.one_shared.view(), parameters);
  for (const Surface& surface : deformable)
    test_pairs(features_.hinges(surface.first_triangle, static_cast<Index>(surface.triangles.size())), parameters);
}

// In cloth without sharp creases, all triangles away from the border are clear, so few pairs with a common vertex are
// tested. This saves up to 13 % of the time of the scene ball_through_cloth.
void ProximityFinder::gather(std::size_t count, const AppendPairs& append_apart, std::span<const Surface> deformable,
                             std::span<const Vec3> x, double radius, double min_fold,
                             std::span<const std::uint8_t> clear) {
  const GatherParameters parameters = begin_gathering(x, radius, min_fold);
  parallel_append(count, kPairsPerBatch, pairs_, [&](std::size_t begin, std::size_t end, FeaturePairs& found) {
    Gathering gathering(*this, parameters, found);
    PairList candidates;
    for (; begin < end; begin += kPairsPerBatch) {
      candidates.clear();
      append_apart(begin, std::min(begin + kPairsPerBatch, end), candidates);
      gathering.test_pairs(candidates.view());
    }
  });
  for (const Surface& surface : deformable)
    parallel_append(surface.triangles.size(), kGrainSize, pairs_,
                    [&](std::size_t begin, std::size_t end, FeaturePairs& found) {
                      Gathering gathering(*this, parameters, found);
                      std::vector<TrianglePair> pairs;
                      for (; begin < end; begin += kTrianglesPerBatch) {
                        pairs.clear();
                        append_connected(begin, std::min(begin + kTrianglesPerBatch, end), surface, clear, pairs);
                        gathering.test_pairs(pairs);
                      }
                    });
}

// Lists pairs a < b with a common vertex, for triangles a in [begin, end) of a surface. Skips clear triangles.
void ProximityFinder::append_connected(std::size_t begin, std::size_t end, const Surface& surface,
                                       std::span<const std::uint8_t> clear, std::vector<TrianglePair>& pairs) const {
  for (std::size_t t = begin; t < end; ++t) {
    const Index a = surface.first_triangle + static_cast<Index>(t);
    if (clear[a]) continue;
    const std::size_t first = pairs.size();
    for (const Index v : features_.triangle(a))
      for (const Index b : features_.triangles_at(v)) {
        // A pair with a common edge is found twice.
        const auto is_it = [&](const TrianglePair& pair) { return pair.b == b; };
        if (b > a && !clear[b] && std::none_of(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), is_it))
          pairs.push_back({a, b});
      }
  }
}

void ProximityFinder::find(std::span<const Vec3> x, double detection_distance, std::vector<Proximity>& out) const {
  out.clear();
  const std::vector<VertexFace>& vertex_faces = pairs_.vertex_faces;
  const std::vector<EdgeEdge>& edge_edges = pairs_.edge_edges;
  parallel_append(vertex_faces.size(), kGrainSize, out, [&](std::size_t begin, std::size_t end, auto& list) {
    Search search(features_, x, detection_distance, list);
    for (std::size_t p = begin; p < end; ++p) search.vertex_face(vertex_faces[p].vertex, vertex_faces[p].face);
  });
  parallel_append(edge_edges.size(), kGrainSize, out, [&](std::size_t begin, std::size_t end, auto& list) {
    Search search(features_, x, detection_distance, list);
    for (std::size_t p = begin; p < end; ++p) search.edges(edge_edges[p]);
  });
  // The order of candidate pairs depends on the shape of the trees. Without sorting, the rounding
  // of later sums would depend on this order.
  std::ranges::sort(out, {}, [](const Proximity& near) { return std::tie(near.kind, near.vertices); });
}

}  // namespace weft::collision
