// Compares the nearest point of a surface with the known result for a box. The search in the hierarchy must equal the
// search over all triangles bit by bit.
#include "physics/collision/proximity/surface_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "collision/hierarchy/test_motions.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::collision {
namespace {

using testing::random_vec;

// Expected signed distance: outside the box, the distance to its nearest point; inside, minus the smallest depth below
// a face.
TEST(NearestPoint, TellsTheSignedDistanceToABox) {
  const Vec3 half(0.1, 0.2, 0.05);
  const mesh::Mesh box = mesh::make_box(2 * half, 0, 1);
  for (int i = 0; i < 9 * 9 * 9; ++i) {
    const Vec3 p = Vec3(i % 9 - 4, i / 9 % 9 - 4, i / 81 - 4).cwiseProduct(Vec3(0.041, 0.073, 0.027));
    const Vec3 beyond = p.cwiseAbs() - half;
    const double expected = beyond.maxCoeff() < 0 ? beyond.maxCoeff() : beyond.cwiseMax(0.0).norm();
    const SurfacePoint found = nearest_point(p, box.topology.triangles, box.positions);
    EXPECT_NEAR(found.height, expected, 1e-15) << p.transpose();  // tolerance: rounding of coordinates up to 0.3 m
  }
}

/// Surfaces with a common numbering, a broad phase fitted to a motion, and positions within its margin.
struct Fitted {
  testing::MovingScene scene;
  std::vector<Vec3> x;
  std::vector<Surface> surfaces;
  BroadPhase broad_phase;

  Fitted(const std::vector<testing::TestMesh>& meshes, unsigned seed, double motion, double margin) {
    std::mt19937 generator(seed);
    for (const testing::TestMesh& mesh : meshes) {
      scene.add(mesh);
      x.insert(x.end(), mesh.x.begin(), mesh.x.end());
    }
    surfaces = scene.surfaces();
    broad_phase = BroadPhase(surfaces, x);
    std::vector<Vec3> x_t1 = x;
    for (Vec3& p : x_t1) p += motion * random_vec(generator);
    for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phase.refit(s, {x, x_t1}, margin);
    for (std::size_t v = 0; v < x.size(); ++v)
      x[v] += 0.7 * (x_t1[v] - x[v]) + 0.99 * margin * random_vec(generator).stableNormalized();
  }
};

testing::TestMesh as_test_mesh(const mesh::Mesh& mesh) {
  return {mesh.positions, {mesh.topology.triangles.begin(), mesh.topology.triangles.end()}};
}

/// Scenes: two still boxes, with many equally near faces; a sphere and a box; a folded sheet and a sphere; a single
/// flat open sheet; random triangles, some equal and some without area.
std::vector<Fitted> fitted() {
  const auto box = as_test_mesh(mesh::make_box(Vec3(0.8, 0.6, 0.4), 0, 4)),
             sphere = as_test_mesh(mesh::make_sphere(0.5, 16));
  std::vector<Fitted> all;
  all.emplace_back(std::vector{box, box}, 1, 0, 0);
  all.emplace_back(std::vector{sphere, box}, 2, 0, 0.05);
  all.emplace_back(std::vector{testing::folded_sheet(15, 3, 0.05), sphere}, 3, 0.05, 0.01);
  all.emplace_back(std::vector{testing::folded_sheet(9, 1, 0)}, 4, 0, 0.001);
  all.emplace_back(std::vector{testing::triangle_soup(4, 20, 200, 0.2)}, 4, 0, 0.02);
  return all;
}

bool same_bits(const SurfacePoint& a, const SurfacePoint& b) {
  return a.face == b.face && a.weights == b.weights && a.normal == b.normal && a.height == b.height;
}

TEST(NearestPoint, ByHierarchyHasTheBitsOfThatOfAllTriangles) {
  std::mt19937 generator(5);
  for (const Fitted& scene : fitted())
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
      for (int i = 0; i < 500; ++i) {
        // The point is random, a vertex, or on the z axis, which is an axis of symmetry of box and sphere, so that
        // several faces are equally near.
        const Index vertex =
            scene.surfaces[s].first_vertex + static_cast<Index>(generator() % 1000) % scene.surfaces[s].vertex_count;
        const Vec3 p = i % 10 == 0 ? scene.x[vertex] : i % 10 == 1 ? Vec3(0, 0, 0.01 * i) : random_vec(generator);
        const SurfacePoint expected = nearest_point(p, scene.surfaces[s].triangles, scene.x);
        EXPECT_TRUE(same_bits(nearest_point(p, scene.broad_phase, s, scene.x), expected)) << p.transpose();
      }
}

TEST(NearestPoint, LooksAtFacesOfOneDirectionAloneWhereThereAreAny) {
  std::mt19937 generator(6);
  int some = 0, none = 0;
  for (const Fitted& scene : fitted())
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
      for (int i = 0; i < 200; ++i) {
        const Vec3 p = random_vec(generator), towards = random_vec(generator).stableNormalized();
        std::vector<Triangle> facing;
        for (const Triangle& t : scene.surfaces[s].triangles)
          if (face_normal(t, scene.x).dot(towards) > 0.5) facing.push_back(t);
        ++(facing.empty() ? none : some);
        const std::span<const Triangle> those = facing.empty() ? scene.surfaces[s].triangles : facing;
        const SurfacePoint found = nearest_point(p, scene.broad_phase, s, scene.x, towards);
        EXPECT_TRUE(same_bits(found, nearest_point(p, those, scene.x))) << p.transpose();
      }
  EXPECT_GT(some, 500);
  EXPECT_GT(none, 50);
}

// The point is 1 cm from a side of the box, and 3 cm above its bottom. The query asks for the bottom.
TEST(NearestPoint, OfOneDirectionIsNotThatOfTheNearestSide) {
  const Fitted scene({as_test_mesh(mesh::make_box(Vec3(0.2, 0.2, 0.1), 0, 1))}, 1, 0, 0);
  const SurfacePoint found = nearest_point({0.09, 0, -0.02}, scene.broad_phase, 0, scene.x, -Vec3::UnitZ());
  EXPECT_NEAR(found.height, -0.03, 1e-15);
  EXPECT_LT((found.normal + Vec3::UnitZ()).norm(), 1e-14);
}

TEST(TrianglesNear, AreThoseWhoseBoxesAreWithinReachInTheirOrder) {
  std::mt19937 generator(7);
  std::size_t max_ties = 0;
  for (const Fitted& scene : fitted())
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
      for (int i = 0; i < 100; ++i) {
        const Triangle& t = scene.scene.triangles[generator() % scene.scene.triangles.size()];
        const double reach = i % 2 == 0 ? 1e-6 : 0.05;
        const auto low = [&](const Triangle& u) {
          return scene.x[u[0]].cwiseMin(scene.x[u[1]]).cwiseMin(scene.x[u[2]]).eval();
        };
        const auto high = [&](const Triangle& u) {
          return scene.x[u[0]].cwiseMax(scene.x[u[1]]).cwiseMax(scene.x[u[2]]).eval();
        };
        std::vector<Triangle> expected;
        for (const Triangle& u : scene.surfaces[s].triangles)
          if ((low(t) - high(u)).maxCoeff() < reach && (low(u) - high(t)).maxCoeff() < reach) expected.push_back(u);
        EXPECT_EQ(triangles_near(t, scene.broad_phase, s, scene.x, reach), expected);
        max_ties = std::max(max_ties, expected.size());
      }
  EXPECT_GT(max_ties, 10U);
}

// A point is inside if a ray from it leaves the surface more often than it enters. The surface may overlap itself.
TEST(IsInside, CountsWhatLetsOutOverWhatLetsInSoThatPartsMayOverlap) {
  // One surface of two boxes that overlap for x from −0.1 to 0.1 m, and a second surface: a box below.
  testing::TestMesh both = as_test_mesh(mesh::make_box(Vec3(0.4, 0.2, 0.2), 0, 2));
  const testing::TestMesh box = both;
  const auto count = static_cast<Index>(box.x.size());
  for (Vec3& p : both.x) p.x() -= 0.1;
  for (const Vec3& p : box.x) both.x.emplace_back(p + Vec3(0.1, 0, 0));
  for (const auto& t : box.triangles) both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  testing::TestMesh below = box;
  for (Vec3& p : below.x) p.z() -= 0.3;
  const Fitted scene({both, below}, 1, 0, 0);
  std::mt19937 generator(7);
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = 0.35 * random_vec(generator), towards = random_vec(generator);
    const bool expected = std::abs(p.x()) < 0.3 && std::abs(p.y()) < 0.1 && std::abs(p.z()) < 0.1;
    EXPECT_EQ(is_inside(p, towards, scene.broad_phase, 0, scene.x), expected) << p.transpose();
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

TEST(NearestPoint, OfSomeFacesAloneIsThatOfThese) {
  const Fitted scene({as_test_mesh(mesh::make_box(Vec3(0.2, 0.2, 0.2), 0, 1))}, 1, 0, 0);
  const auto faces_up = [&](const Triangle& face) { return face_normal(face, scene.x).z() > 0.5; };
  const SurfacePoint found = nearest_point({0.09, 0, -0.02}, scene.broad_phase, 0, scene.x, Vec3::Zero(), faces_up);
  EXPECT_NEAR(found.height, -0.12, 1e-15);
}

TEST(FindCrossing, TellsWhereOnTheFirstTriangleAndNothingForTrianglesApart) {
  const std::vector<Vec3> x{{0, 0, -1}, {0, 0, 3}, {5, 0, 9}, {-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}};
  const auto weights = find_crossing({0, 1, 2}, {3, 4, 5}, x);
  ASSERT_TRUE(weights.has_value());
  Vec3 place = Vec3::Zero();
  for (int c = 0; c < 3; ++c) place += (*weights)[c] * x[c];
  EXPECT_NEAR(place[2], 0, 1e-15);
  EXPECT_NEAR(place[1], 0, 1e-15);
  // The triangles intersect along a segment of the x axis, from 0 to `end`; the result is its midpoint.
  const double end = 5.0 / 10;  // x where the edge from the first to the last corner pierces the other triangle
  EXPECT_NEAR(place[0], 0.5 * end, 1e-15);
  EXPECT_FALSE(
      find_crossing({0, 2, 2}, {3, 4, 5}, std::vector<Vec3>{{0, 0, 1}, {0, 0, 3}, {5, 0, 9}, x[3], x[4], x[5]}));
}

}  // namespace
}  // namespace weft::collision
