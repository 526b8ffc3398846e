#include "collision/proximity/proximities.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "collision/proximity/closest_points.hpp"
#include "core/parallel_append.hpp"

namespace weft::collision {

namespace {

// Whose pairs with a common vertex are listed before they are looked at: six to nine each.
constexpr std::size_t kTrianglesListed = 64;

/// Unit vector along v, or along a fallback where the two features touch and v has no direction.
Vec3 direction(const Vec3& v, const Vec3& fallback) {
  if (const double length_sq = v.squaredNorm(); length_sq > 1e-280) return v / std::sqrt(length_sq);
  for (const Vec3& tiny : {v, fallback}) {
    const double length = tiny.stableNorm();
    if (length > 0) return tiny / length;
  }
  return Vec3::UnitZ();
}

}  // namespace

/// How a gathering looks.
struct ProximityFinder::First {
  std::span<const Vec3> x;
  double radius;
  float radius_rounded;
  double flattest;
};

/// From pairs of triangles to pairs of features within a radius.
class ProximityFinder::Gathering {
 public:
  Gathering(const ProximityFinder& finder, const First& first, FeaturePairs& found)
      : finder_(finder),
        found_(found),
        features_(finder.features_),
        rounded_(finder.rounded_),
        x_(first.x),
        radius_sq_(first.radius * first.radius),
        radius_rounded_(first.radius_rounded),
        flattest_(static_cast<float>(first.flattest)) {}

  /// All features that the two triangles of each pair own, against each other. First the boxes of vertices, edges and
  /// faces, for eight pairs at once and without branches: which feature is near is as good as random, and a wrong
  /// guess of the processor costs more than the test. Measured 3 times faster than pair by pair.
  void look_at(std::span<const TrianglePair> pairs) {
    for (; pairs.size() >= 8; pairs = pairs.subspan(8)) look_at_eight(pairs.first<8>(), 8);
    if (pairs.empty()) return;
    std::array<TrianglePair, 8> rest;
    std::copy(pairs.begin(), pairs.end(), rest.begin());
    std::fill(rest.begin() + static_cast<std::ptrdiff_t>(pairs.size()), rest.end(), pairs.front());
    look_at_eight(rest, pairs.size());
  }

 private:
  struct Boxes {
    Points8 low, high;
  };

  /// One side of eight pairs.
  struct Side {
    std::array<Points8, 3> at;  // by corner
    std::array<Boxes, 3> edge;  // edge i goes from corner i to corner i + 1
    Boxes face;
    std::array<IntLanes8, 3> corner;     // vertex numbers
    std::array<std::uint32_t, 6> owned;  // bit l: the triangle in lane l owns corner 0 to 2, edge 0 to 2

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

  /// Bit l is set where the boxes in lane l are within reach.
  static std::uint32_t near(const Points8& a_low, const Points8& a_high, const Boxes& b, const Lanes8& radius) {
    Lanes8 gap = a_low.axis[0] - b.high.axis[0];
    raise_to(gap, b.low.axis[0] - a_high.axis[0]);
    for (std::size_t axis = 1; axis < 3; ++axis) {
      raise_to(gap, a_low.axis[axis] - b.high.axis[axis]);
      raise_to(gap, b.low.axis[axis] - a_high.axis[axis]);
    }
    return sign_mask(gap - radius);
  }

  /// The radius for boxes of these triangles in float. Rounding moves a coordinate by 2^-24 of itself, so a gap of two
  /// by four times that at most; only the pair's own coordinates count, so that no other body has an influence.
  Lanes8 rounded_radius(const Boxes& a, const Boxes& b) const {
    Lanes8 largest = a.high.axis[0];
    for (const Boxes* box : {&a, &b})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        raise_to(largest, box->high.axis[axis]);
        raise_to(largest, -box->low.axis[axis]);
      }
    return radius_rounded_ + largest * 0x1p-21F;
  }

  void look_at_eight(std::span<const TrianglePair, 8> pairs, std::size_t count) {
    std::array<Index, 8> number_a, number_b;
    for (std::size_t l = 0; l < 8; ++l) number_a[l] = pairs[l].a, number_b[l] = pairs[l].b;
    const Side a(features_, rounded_, number_a), b(features_, rounded_, number_b);
    const Lanes8 radius = rounded_radius(a.face, b.face);
    const std::uint32_t together = near(a.face.low, a.face.high, b.face, radius) & ((1U << count) - 1);
    if (together == 0) return;
    std::array<std::array<std::uint32_t, 3>, 3> same;  // corner i of a is corner j of b
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
          keep_edges({number_a[l], number_b[l], static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)},
                     {a.corner[i][l], a.corner[i1][l], b.corner[j][l], b.corner[j1][l]});
        });
      }
    }
  }

  const Vec3& at(Index vertex) const { return x_[vertex]; }

  void keep_vertex_face(Index vertex, Index face) {
    const Triangle& corners = features_.triangle(face);
    if (!surely_farther(at(vertex), at(corners[0]), at(corners[1]), at(corners[2]), radius_sq_))
      found_.vertex_faces.push_back({vertex, face});
  }

  void keep_edges(const EdgeEdge& edges, const std::array<Index, 4>& v) {
    if (flattest_ > 0 && fold(edges.face_a, edges.edge_a) + fold(edges.face_b, edges.edge_b) < flattest_) return;
    if (!surely_farther_edges(at(v[0]), at(v[1]), at(v[2]), at(v[3]), radius_sq_)) found_.edge_edges.push_back(edges);
  }

  float fold(Index face, std::size_t edge) const { return finder_.folds_[face][edge]; }

  const ProximityFinder& finder_;
  FeaturePairs& found_;
  const Features& features_;
  const std::vector<Rounded>& rounded_;
  std::span<const Vec3> x_;
  const double radius_sq_;
  const float radius_rounded_;
  const float flattest_;
};

/// From pairs of features to proximities.
class ProximityFinder::Search {
 public:
  Search(const Features& features, std::span<const Vec3> x, double reach, std::vector<Proximity>& out)
      : features_(features), x_(x), reach_sq_(reach * reach), out_(out) {}

  void vertex_face(Index vertex, Index face) {
    const Triangle& corners = features_.triangle(face);
    if (surely_farther(at(vertex), at(corners[0]), at(corners[1]), at(corners[2]), reach_sq_)) return;
    const ClosestPoints points = closest_to_face(vertex, corners);
    if (!(points.distance_sq < reach_sq_)) return;
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
      if (other < face || closest_to_face(vertex, around).distance_sq < (1 - kRoundoff) * points.distance_sq)
        return true;
    }
    return false;
  }

  void edges(const EdgeEdge& pair) {
    const Triangle &a = features_.triangle(pair.face_a), &b = features_.triangle(pair.face_b);
    const std::array<Index, 4> v{a[pair.edge_a], a[(pair.edge_a + 1) % 3], b[pair.edge_b], b[(pair.edge_b + 1) % 3]};
    if (surely_not_inside(at(v[0]), at(v[1]), at(v[2]), at(v[3]), reach_sq_)) return;
    const ClosestPoints points = closest_edge_edge(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
    // With an end as closest point the vertex and the faces at the other edge represent the pair.
    if (!(points.distance_sq < reach_sq_) || points.support() != 0b1111U) return;
    const Vec3 across = (at(v[1]) - at(v[0])).cross(at(v[3]) - at(v[2]));
    const Vec3 normal = direction(points.difference, across);
    add(ProximityKind::edge_edge, v, points, across,
        {outside_wedge(v[0], v[1], features_.apexes(pair.face_a, pair.edge_a), -normal),
         outside_wedge(v[2], v[3], features_.apexes(pair.face_b, pair.edge_b), normal)});
  }

 private:
  const Vec3& at(Index vertex) const { return x_[vertex]; }

  /// Largest sine of the angle by which the unit direction `outward`, which is perpendicular to the edge, points to the
  /// inside of one of its faces: |e| (arm · outward) / |e × arm|.
  double outside_wedge(Index e0, Index e1, std::span<const Index> apexes, const Vec3& outward) const {
    const Vec3 edge = at(e1) - at(e0);
    const double length = edge.norm();
    double most = -1;
    for (const Index apex : apexes) {
      const Vec3 arm = at(apex) - at(e0);
      const double across = edge.cross(arm).norm();
      if (across > 0) most = std::max(most, length * arm.dot(outward) / across);
    }
    return most;
  }

  void add(ProximityKind kind, const std::array<Index, 4>& vertices, const ClosestPoints& points, const Vec3& fallback,
           const std::array<double, 2>& outside) {
    out_.push_back(
        {{vertices, points.weights, direction(points.difference, fallback), std::sqrt(points.distance_sq), kind},
         outside});
  }

  const Features& features_;
  std::span<const Vec3> x_;
  const double reach_sq_;
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
  // 1 − cos θ = 2 sin² (θ / 2)
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

ProximityFinder::First ProximityFinder::begin_gathering(std::span<const Vec3> x, double radius, double flattest) {
  if (flattest > 0) measure_folds(x);
  // First look in float.
  rounded_.resize(x.size());
  parallel_for(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      rounded_[v].xyz =
          Lanes4{static_cast<float>(x[v][0]), static_cast<float>(x[v][1]), static_cast<float>(x[v][2]), 0.0F};
  });
  pairs_.vertex_faces.clear();
  pairs_.edge_edges.clear();
  return {x, radius, static_cast<float>(radius * (1 + 1e-6) + 1e-37), flattest};
}

void ProximityFinder::look_at(std::span<const TrianglePair> pairs, const First& first) {
  parallel_append(pairs.size(), kGrainSize, pairs_, [&](std::size_t begin, std::size_t end, FeaturePairs& found) {
    Gathering(*this, first, found).look_at(pairs.subspan(begin, end - begin));
  });
}

void ProximityFinder::gather(const CandidatePairs& candidates, std::span<const Surface> deformable,
                             std::span<const Vec3> x, double radius, double flattest) {
  const First first = begin_gathering(x, radius, flattest);
  look_at(candidates.apart.view(), first);
  look_at(candidates.one_shared.view(), first);
  for (const Surface& surface : deformable)
    look_at(features_.hinges(surface.first_triangle, static_cast<Index>(surface.triangles.size())), first);
}

// Of cloth that is not creased sharply nothing is left of the connected ones, which were 13 % of the run of
// ball_through_cloth.
void ProximityFinder::gather(const PairList& apart, std::span<const Surface> deformable, std::span<const Vec3> x,
                             double radius, double flattest, std::span<const std::uint8_t> open) {
  const First first = begin_gathering(x, radius, flattest);
  look_at(apart.view(), first);
  for (const Surface& surface : deformable)
    parallel_append(surface.triangles.size(), kGrainSize, pairs_,
                    [&](std::size_t begin, std::size_t end, FeaturePairs& found) {
                      Gathering gathering(*this, first, found);
                      std::vector<TrianglePair> pairs;
                      for (; begin < end; begin += kTrianglesListed) {
                        pairs.clear();
                        append_connected(begin, std::min(begin + kTrianglesListed, end), surface, open, pairs);
                        gathering.look_at(pairs);
                      }
                    });
}

// Pairs a < b with a common vertex, of triangles a in [begin, end) of a surface; none of both is open.
void ProximityFinder::append_connected(std::size_t begin, std::size_t end, const Surface& surface,
                                       std::span<const std::uint8_t> open, std::vector<TrianglePair>& pairs) const {
  for (std::size_t t = begin; t < end; ++t) {
    const Index a = surface.first_triangle + static_cast<Index>(t);
    if (open[a]) continue;
    const std::size_t first = pairs.size();
    for (const Index v : features_.triangle(a))
      for (const Index b : features_.triangles_at(v)) {
        // Across an edge it comes twice.
        const auto is_it = [&](const TrianglePair& pair) { return pair.b == b; };
        if (b > a && !open[b] && std::none_of(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), is_it))
          pairs.push_back({a, b});
      }
  }
}

void ProximityFinder::find(std::span<const Vec3> x, double reach, std::vector<Proximity>& out) const {
  out.clear();
  const std::vector<VertexFace>& vertex_faces = pairs_.vertex_faces;
  const std::vector<EdgeEdge>& edge_edges = pairs_.edge_edges;
  parallel_append(vertex_faces.size(), kGrainSize, out, [&](std::size_t begin, std::size_t end, auto& list) {
    Search search(features_, x, reach, list);
    for (std::size_t p = begin; p < end; ++p) search.vertex_face(vertex_faces[p].vertex, vertex_faces[p].face);
  });
  parallel_append(edge_edges.size(), kGrainSize, out, [&](std::size_t begin, std::size_t end, auto& list) {
    Search search(features_, x, reach, list);
    for (std::size_t p = begin; p < end; ++p) search.edges(edge_edges[p]);
  });
}

}  // namespace weft::collision
