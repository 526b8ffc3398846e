// Compares near pairs with brute force over all features, as sets.
#include "physics/collision/proximity/proximities.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "collision/hierarchy/test_meshes.hpp"
#include "physics/collision/hierarchy/traversal.hpp"
#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/response/separation.hpp"

namespace weft::collision {
namespace {

using testing::folded_sheet;
using testing::random_vec;
using testing::TestMesh;

using Edge = std::array<Index, 2>;

/// Identifies a pair of features by its vertices, each side sorted.
using Key = std::pair<std::vector<Index>, std::vector<Index>>;

Key key(const Proximity& p) {
  const auto split = p.vertices.begin() + (p.kind == ProximityKind::vertex_face ? 1 : 2);
  std::vector<Index> a(p.vertices.begin(), split), b(split, p.vertices.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  if (p.kind == ProximityKind::edge_edge && b < a) std::swap(a, b);
  return {a, b};
}

std::set<Edge> edges_of(const TestMesh& mesh) {
  std::set<Edge> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c) edges.insert({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  return edges;
}

const Vec3& at(const TestMesh& mesh, Index v) {
  return mesh.x[v];
}

ClosestPoints to_face(const TestMesh& mesh, Index v, const Triangle& t) {
  return closest_vertex_face(at(mesh, v), at(mesh, t[0]), at(mesh, t[1]), at(mesh, t[2]));
}

/// All feature pairs without a common vertex, with their closest points.
struct AllPairs {
  std::map<Key, ClosestPoints> vertex_face, edge_edge;

  explicit AllPairs(const TestMesh& mesh) {
    for (Index v = 0; v < static_cast<Index>(mesh.x.size()); ++v)
      for (const Triangle& t : mesh.triangles) {
        if (has_vertex(t, v)) continue;
        std::vector<Index> face(t.begin(), t.end());
        std::sort(face.begin(), face.end());
        vertex_face.emplace(Key{{v}, face}, to_face(mesh, v, t));
      }
    const std::set<Edge> edges = edges_of(mesh);
    for (const Edge& a : edges)
      for (const Edge& b : edges) {
        if (!(a < b) || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
        edge_edge.emplace(Key{{a[0], a[1]}, {b[0], b[1]}},
                          closest_edge_edge(at(mesh, a[0]), at(mesh, a[1]), at(mesh, b[0]), at(mesh, b[1])));
      }
  }
};

/// Finds near pairs. `shuffle`: puts the candidates into a random order, and swaps the two triangles of half of them.
std::vector<Proximity> find(const TestMesh& mesh, double reach, std::mt19937* shuffle = nullptr) {
  Tree<6> tree(mesh.surface(), mesh.x);
  tree.refit({mesh.x, mesh.x}, reach / 2);
  CandidatePairs candidates;
  self_pairs(tree, candidates);
  if (shuffle != nullptr)
    for (PairList* list : {&candidates.apart, &candidates.one_shared}) {
      std::vector<TrianglePair> pairs(list->begin(), list->end());
      std::shuffle(pairs.begin(), pairs.end(), *shuffle);
      for (std::size_t p = 0; p < pairs.size(); p += 2) std::swap(pairs[p].a, pairs[p].b);
      list->clear();
      list->append(pairs);
    }
  ProximityFinder finder(mesh.triangles, static_cast<Index>(mesh.x.size()));
  const Surface surface = mesh.surface();
  std::vector<Proximity> out;
  finder.find(candidates, std::span(&surface, 1), mesh.x, reach, out);
  return out;
}

/// A sheet in three layers. Each vertex is moved at random by up to `roughness` [m] along each axis, so that no
/// distances are equal.
TestMesh rough_layers(unsigned seed, int n = 12, double roughness = 0.02) {
  TestMesh mesh = folded_sheet(n, 3, 0.03);
  std::mt19937 generator(seed);
  for (Vec3& p : mesh.x) p += roughness * random_vec(generator);
  return mesh;
}

/// Scenes, in this order: aligned layers with equal distances; aligned layers without a gap; two without equal
/// distances; crossing surfaces; random triangles.
std::vector<TestMesh> scenes() {
  // Keeps one of several equal triangles, since this test identifies features by their vertices.
  TestMesh soup = testing::triangle_soup(4, 12, 60, 0.3);
  std::set<std::set<Index>> seen;
  std::erase_if(soup.triangles, [&](const Triangle& t) { return !seen.insert({t.begin(), t.end()}).second; });
  return {folded_sheet(12, 3, 0.01), folded_sheet(13, 4, 0),   rough_layers(1),
          rough_layers(2),           rough_layers(3, 10, 0.1), soup};
}

TEST(Proximities, AreConsistentAndEachPairOfFeaturesIsListedOnce) {
  for (const TestMesh& mesh : scenes()) {
    std::set<Key> seen;
    for (const Proximity& p : find(mesh, 0.05)) {
      EXPECT_TRUE(seen.insert(key(p)).second);
      EXPECT_EQ(std::set<Index>(p.vertices.begin(), p.vertices.end()).size(), 4U);
      EXPECT_LT(p.distance, 0.05);
      EXPECT_NEAR(p.normal.norm(), 1, 1e-14);
      Vec3 difference = Vec3::Zero();
      for (std::size_t i = 0; i < 4; ++i) difference += p.weights[i] * at(mesh, p.vertices[i]);
      EXPECT_LE((difference - p.distance * p.normal).norm(), 1e-14);
      const std::size_t on_a = p.kind == ProximityKind::vertex_face ? 1 : 2;
      double sum_a = 0, sum_b = 0;
      for (std::size_t i = 0; i < 4; ++i) (i < on_a ? sum_a : sum_b) += p.weights[i];
      EXPECT_NEAR(sum_a, 1, 1e-15);
      EXPECT_NEAR(sum_b, -1, 1e-15);
    }
  }
}

TEST(Proximities, HaveAnOrderOfTheirOwn) {
  std::mt19937 generator(5);
  for (const TestMesh& mesh : scenes()) {
    const std::vector<Proximity> expected = find(mesh, 0.05), found = find(mesh, 0.05, &generator);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t p = 0; p < found.size(); ++p) {
      EXPECT_EQ(found[p].vertices, expected[p].vertices) << p;
      EXPECT_EQ(found[p].weights, expected[p].weights) << p;
      EXPECT_EQ(found[p].normal, expected[p].normal) << p;
    }
  }
}

TEST(Proximities, InsideAFaceOrInsideBothEdgesAreThoseOfBruteForce) {
  for (const TestMesh& mesh : scenes()) {
    const double reach = 0.05;
    std::map<Key, double> expected, found;
    const AllPairs all(mesh);
    for (const auto& [pair, points] : all.vertex_face)
      if (points.support() == 0b1111U && points.distance_sq < reach * reach)
        expected[pair] = std::sqrt(points.distance_sq);
    for (const auto& [pair, points] : all.edge_edge)
      if (points.support() == 0b1111U && points.distance_sq < reach * reach)
        expected[pair] = std::sqrt(points.distance_sq);
    for (const Proximity& p : find(mesh, reach))
      if (std::all_of(p.weights.begin(), p.weights.end(), [](double w) { return w != 0; })) found[key(p)] = p.distance;
    EXPECT_EQ(found.size(), expected.size());
    for (const auto& [pair, distance] : expected) {
      if (!found.contains(pair)) {
        ADD_FAILURE() << ::testing::PrintToString(pair) << " at " << distance << " m is missing";
      } else {
        EXPECT_NEAR(found[pair], distance, 1e-13);
      }
    }
  }
}

TEST(Proximities, OnAnEdgeOrCornerAreThoseWhereNoFaceAroundIsCloser) {
  // Expected: a vertex with an edge or corner on which the closest points of all faces around this edge or corner lie.
  // Pairs of two vertices are listed for the vertex with the lower number.
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const TestMesh mesh = rough_layers(seed);
    const double reach = 0.05;
    using Support = std::pair<Index, std::set<Index>>;  // vertex; edge or corner
    std::map<Support, std::vector<bool>> nearest;       // per face around it: whether its closest point is on it
    for (Index v = 0; v < static_cast<Index>(mesh.x.size()); ++v) {
      std::set<std::set<Index>> supports;
      for (const Triangle& t : mesh.triangles) {
        if (has_vertex(t, v)) continue;
        const ClosestPoints c = to_face(mesh, v, t);
        std::set<Index> on;
        for (std::size_t i = 0; i < 3; ++i)
          if (c.weights[i + 1] != 0) on.insert(t[i]);
        if (c.distance_sq < reach * reach && on.size() < 3) supports.insert(on);
      }
      for (const std::set<Index>& on : supports)
        for (const Triangle& t : mesh.triangles) {
          if (has_vertex(t, v) || !std::all_of(on.begin(), on.end(), [&](Index c) { return has_vertex(t, c); }))
            continue;
          const ClosestPoints c = to_face(mesh, v, t);
          bool same = true;
          for (std::size_t i = 0; i < 3; ++i) same &= (c.weights[i + 1] != 0) == on.contains(t[i]);
          nearest[{v, on}].push_back(same);
        }
    }
    const auto is_nearest = [&](const Support& s) {
      const auto found = nearest.find(s);
      return found != nearest.end() &&
             std::all_of(found->second.begin(), found->second.end(), [](bool b) { return b; });
    };
    std::set<Support> expected, found;
    for (const auto& [support, faces] : nearest)
      if (is_nearest(support) && (support.second.size() == 2 || support.first < *support.second.begin()))
        expected.insert(support);
    for (const Proximity& p : find(mesh, reach)) {
      if (p.kind == ProximityKind::edge_edge) continue;
      std::set<Index> on;
      for (std::size_t i = 1; i < 4; ++i)
        if (p.weights[i] != 0) on.insert(p.vertices[i]);
      if (on.size() < 3) {
        EXPECT_TRUE(found.insert({p.vertices[0], on}).second) << "listed with two faces";
      }
    }
    EXPECT_GT(expected.size(), 20U);
    EXPECT_EQ(found, expected);
  }
}

TEST(Proximities, RepresentTheLeastDistanceOfEveryFeaturePair) {
  // Checks the claim of proximities.hpp by the steps of its proof: start at any near pair of triangles without a common
  // vertex, go to the faces around the closest point, and end at a listed pair that is no farther apart.
  constexpr double kRounding = 1e-12;
  for (const TestMesh& mesh : scenes()) {
    const double reach = 0.05;
    std::set<Key> listed;
    for (const Proximity& p : find(mesh, reach)) listed.insert(key(p));
    const AllPairs all(mesh);

    // Whether steps to faces around the closest point lead from this vertex and face to a listed pair. All faces on the
    // way must be within `distance` [m] of the vertex.
    const auto represented = [&](Index v, const Triangle& face, double distance) {
      std::set<std::pair<Index, Triangle>> seen, open{{v, face}};
      while (!open.empty()) {
        const auto [vertex, t] = *open.begin();
        open.erase(open.begin());
        if (!seen.insert({vertex, t}).second) continue;
        std::vector<Index> sorted(t.begin(), t.end());
        std::sort(sorted.begin(), sorted.end());
        if (listed.contains(Key{{vertex}, sorted})) return true;
        const ClosestPoints c = to_face(mesh, vertex, t);
        std::vector<Index> on;
        for (std::size_t i = 0; i < 3; ++i)
          if (c.weights[i + 1] != 0) on.push_back(t[i]);
        const auto step = [&](Index from, const Triangle& to) {
          if (!has_vertex(to, from) && std::sqrt(to_face(mesh, from, to).distance_sq) <= distance + kRounding)
            open.insert({from, to});
        };
        for (const Triangle& to : mesh.triangles) {
          if (std::all_of(on.begin(), on.end(), [&](Index i) { return has_vertex(to, i); })) step(vertex, to);
          if (on.size() == 1 && has_vertex(to, vertex)) step(on[0], to);
        }
      }
      return false;
    };

    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
        const Triangle &a = mesh.triangles[i], &b = mesh.triangles[j];
        if (std::any_of(a.begin(), a.end(), [&](Index v) { return has_vertex(b, v); })) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          const double distance = std::sqrt(to_face(mesh, a[c], b).distance_sq);
          if (distance < reach) {
            EXPECT_TRUE(represented(a[c], b, distance)) << a[c] << " and triangle " << j;
          }
          for (std::size_t d = 0; d < 3; ++d) {
            const Edge e{a[c], a[(c + 1) % 3]}, f{b[d], b[(d + 1) % 3]};
            const ClosestPoints points =
                closest_edge_edge(at(mesh, e[0]), at(mesh, e[1]), at(mesh, f[0]), at(mesh, f[1]));
            if (points.support() == 0b1111U || !(points.distance_sq < reach * reach)) continue;
            // The closest point of one edge is an end of it: this vertex and the triangle of the other edge must be
            // represented.
            const bool end_of_e = points.weights[0] == 0 || points.weights[1] == 0;
            const Index end = end_of_e ? e[points.weights[0] == 0] : f[points.weights[2] == 0];
            EXPECT_TRUE(represented(end, end_of_e ? b : a, std::sqrt(points.distance_sq)));
          }
        }
      }
    }
  }
}

/// Whether the triangle has all of these vertices.
bool has_all(const Triangle& t, const std::vector<Index>& vertices) {
  return std::ranges::all_of(vertices, [&](Index v) { return has_vertex(t, v); });
}
/// Whether the triangles have a common vertex.
bool has_one(const Triangle& t, const Triangle& s) {
  return std::ranges::any_of(s, [&](Index v) { return has_vertex(t, v); });
}

// gather() skips the pairs of clear triangles (Separation::find_clear_triangles) with triangles that share a vertex, so
// none of these pairs may be near.
TEST(Proximities, OpenTrianglesAreFartherFromTheirNeighbours) {
  int open_of_all = 0, creased_of_all = 0;
  for (const double roughness : {0.005, 0.02, 0.04}) {
    const TestMesh mesh = rough_layers(4, 12, roughness);
    const Surface surface = mesh.surface();
    const AllPairs all(mesh);
    Separation separation(mesh.triangles, std::span(&surface, 1));
    separation.watch({}, mesh.x);
    for (const double distance : {0.005, 0.02, 0.03}) {
      const std::vector<std::uint8_t> open = separation.find_clear_triangles(distance, mesh.x);
      const auto sides_of_open = [&](const Key& key) {
        for (std::size_t t = 0; t < open.size(); ++t)
          for (const auto& [one, other] : {std::pair(key.first, key.second), std::pair(key.second, key.first)})
            if (open[t] && has_all(mesh.triangles[t], one) &&
                std::ranges::any_of(mesh.triangles, [&, &other = other](const Triangle& s) {
                  return has_all(s, other) && has_one(s, mesh.triangles[t]);
                }))
              return true;
        return false;
      };
      for (const auto* pairs : {&all.vertex_face, &all.edge_edge})
        for (const auto& [key, points] : *pairs)
          if (points.distance_sq < distance * distance) {
            EXPECT_FALSE(sides_of_open(key)) << "roughness " << roughness << ", " << std::sqrt(points.distance_sq);
          }
      open_of_all += static_cast<int>(std::ranges::count(open, 1));
      creased_of_all += static_cast<int>(std::ranges::count(open, 0));
    }
  }
  EXPECT_GT(open_of_all, 300);
  EXPECT_GT(creased_of_all, 300);
}

TEST(Proximities, OfAVertexOverASharedEdgeAndOverACornerAreListedOnce) {
  // A square of two triangles, and a small triangle. Its first vertex is 10 mm above the diagonal of the square, then
  // 5 mm beside a corner.
  TestMesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.3, 0.01}, {0.3, 0.35, 0.5}, {0.35, 0.3, 0.5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  std::vector<Proximity> found = find(mesh, 0.02);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].vertices, (std::array<Index, 4>{4, 0, 1, 2}));
  EXPECT_NEAR(found[0].distance, 0.01, 1e-16);
  EXPECT_EQ(found[0].normal, Vec3(0, 0, 1));

  mesh.x[4] = {-0.003, -0.004, 0};
  mesh.x[5] = {-0.5, -0.5, 0.1};
  mesh.x[6] = {-0.5, -0.4, 0.1};
  found = find(mesh, 0.02);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].distance, 0.005, 1e-16);
  EXPECT_EQ(found[0].vertices[0], 0) << "of two vertices the lower number is the vertex of the pair";
}

TEST(Proximities, WedgeTellsWhetherAFaceNextToTheEdgeIsCloser) {
  // Two roofs, the upper one upside down, with crossed ridges 0.1 m apart. The contact direction, z, is inside the
  // wedges of both ridges.
  TestMesh mesh;
  mesh.x = {{-1, 0, 0}, {1, 0, 0}, {0, -1, -1}, {0, 1, -1}, {0, -1, 0.1}, {0, 1, 0.1}, {-1, 0, 1.1}, {1, 0, 1.1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {4, 5, 6}, {4, 7, 5}};
  const auto ridge = [&](const std::vector<Proximity>& found) {
    const auto p = std::find_if(found.begin(), found.end(), [](const Proximity& q) {
      return key(q) == Key{{0, 1}, {4, 5}};
    });
    EXPECT_NE(p, found.end());
    return *p;
  };
  Proximity p = ridge(find(mesh, 0.15));
  EXPECT_NEAR(p.distance, 0.1, 1e-15);
  EXPECT_NEAR(p.outside_wedge[0], -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(p.outside_wedge[1], -std::sqrt(0.5), 1e-12);

  // The lower roof becomes a valley, whose faces are closer to the upper ridge than its bottom line is.
  mesh.x[2][2] = mesh.x[3][2] = 0.05;
  p = ridge(find(mesh, 0.15));
  EXPECT_NEAR(p.outside_wedge[0], 0.05 / std::hypot(1, 0.05), 1e-12);
}

// A border passes over a flat surface, beside vertex 0 of that surface. A face around this vertex is closer to the
// border than the vertex is.
TEST(Proximities, WedgeOfAVertexTellsWhetherAFaceAroundItIsCloser) {
  TestMesh mesh;
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0.03, -1, 0.04}, {0.03, 1, 0.04}, {1, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {5, 7, 6}};
  const auto at_centre = [&] {
    const auto found = find(mesh, 0.06);
    const auto p = std::find_if(found.begin(), found.end(), [](const Proximity& q) {
      return q.kind == ProximityKind::vertex_face && q.vertices[0] == 0;
    });
    EXPECT_NE(p, found.end());
    return *p;
  };
  EXPECT_NEAR(at_centre().distance, 0.05, 1e-15);
  EXPECT_NEAR(at_centre().outside_wedge[0], 0.03 / 0.05, 1e-12);

  // Vertex 0 becomes the tip of a pyramid, and is now the point of this surface closest to the border.
  for (std::size_t v = 1; v < 5; ++v) mesh.x[v].z() = -1;
  EXPECT_EQ(at_centre().outside_wedge[0], 0);
}

TEST(Features, EachVertexAndEdgeHasOneOwner) {
  const TestMesh mesh = testing::triangle_soup(3, 20, 90, 0.2);
  const Features features(mesh.triangles, static_cast<Index>(mesh.x.size()));
  std::multiset<Index> vertices;
  std::multiset<Edge> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index next = t[(c + 1) % 3];
      if ((features.owned(static_cast<Index>(i)) & (1U << c)) != 0) vertices.insert(t[c]);
      if ((features.owned(static_cast<Index>(i)) & (8U << c)) != 0)
        edges.insert({std::min(t[c], next), std::max(t[c], next)});
    }
  }
  std::multiset<Index> expected_vertices;
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t)
      if (!expected_vertices.contains(v)) expected_vertices.insert(v);
  std::multiset<Edge> expected_edges;
  for (const Edge& e : edges_of(mesh))
    if (e[0] != e[1]) expected_edges.insert(e);
  EXPECT_EQ(vertices, expected_vertices);
  EXPECT_EQ(edges, expected_edges);
}

TEST(Features, HingesAreThePairsWithTwoCommonVertices) {
  const TestMesh mesh = folded_sheet(6, 2, 0.1);
  const Features features(mesh.triangles, static_cast<Index>(mesh.x.size()));
  const auto shared = [](const Triangle& a, const Triangle& b) {
    return std::count_if(a.begin(), a.end(), [&](Index v) { return has_vertex(b, v); });
  };
  const auto count = static_cast<Index>(mesh.triangles.size());
  std::vector<TrianglePair> expected;
  for (Index a = 10; a < count - 5; ++a)
    for (Index b = a + 1; b < count; ++b)
      if (shared(features.triangle(a), features.triangle(b)) == 2) expected.push_back({a, b});
  EXPECT_TRUE(std::ranges::equal(features.hinges(10, count - 15), expected));
}

}  // namespace
}  // namespace weft::collision
