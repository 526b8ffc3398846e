#include "physics/mesh/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include "physics/mesh/geometry.hpp"
#include "support/mesh_measures.hpp"

namespace weft::mesh {
namespace {

constexpr double kPi = std::numbers::pi;

// Tolerance: rounding errors of a sum of a few thousand terms near one.
constexpr double kRoundingOfSums = 1e-12;

double volume(const Mesh& mesh) {
  return support::enclosed_volume(mesh.topology.triangles, mesh.positions);
}

/// Area of a regular polygon inscribed in the unit circle.
double polygon(int corners) {
  return 0.5 * corners * std::sin(2 * kPi / corners);
}

/// Largest height of a vertex above the plane of any triangle; for a convex body, this is at most a rounding error.
double bulge_over_faces(const Mesh& mesh) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.topology.triangles) {
    const Vec3 normal = area_vector(t, mesh.positions).normalized();
    const Vec3& foot = mesh.positions[t[0]];
    for (const Vec3& x : mesh.positions) highest = std::max(highest, normal.dot(x - foot));
  }
  return highest;
}

/// Smallest ratio of height to longest side; 0.87 for an equilateral triangle.
double worst_triangle(const Mesh& mesh) {
  double worst = 1;
  for (const Triangle& t : mesh.topology.triangles) {
    double longest_sq = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = mesh.positions[t[k]];
      const Vec3& b = mesh.positions[t[(k + 1) % 3]];
      longest_sq = std::max(longest_sq, (b - a).squaredNorm());
    }
    worst = std::min(worst, 2 * area_vector(t, mesh.positions).norm() / longest_sq);
  }
  return worst;
}

struct ClosedShape {
  std::string name;
  Mesh mesh;
  int euler = 2;  ///< vertices - edges + faces: 2 for a ball, 0 for a ring
};

std::ostream& operator<<(std::ostream& out, const ClosedShape& shape) {
  return out << shape.name;
}

std::vector<ClosedShape> closed_shapes() {
  std::vector<ClosedShape> shapes;
  for (const int segments : {0, 3, 4, 7, 13, 48}) {
    const auto add = [&](const char* name, Mesh mesh, int euler = 2) {
      shapes.push_back({std::string(name) + std::to_string(segments), std::move(mesh), euler});
    };
    add("sphere", make_sphere(0.5, segments));
    add("box", make_box({1, 2, 3}, 0, segments));
    add("rounded_box", make_box({1, 2, 3}, 0.1, segments));
    add("ball_like_box", make_box({1, 1, 1}, 5, segments));
    add("cone", make_cone(0.5, 1, segments));
    add("flat_cone", make_cone(1, 0.01, segments));
    add("torus", make_torus(0.5, 0.15, segments), 0);
    add("fat_torus", make_torus(0.5, 0.499, segments), 0);
    add("cylinder", make_cylinder(0.5, 1, segments));
    add("bar", make_cylinder(0.01, 2, segments));
    add("half_pipe", make_half_pipe(1, 2, 0.05, segments));
    add("short_half_pipe", make_half_pipe(1, 0.01, 3, segments));
  }
  return shapes;
}

class ClosedShapes : public testing::TestWithParam<ClosedShape> {};

TEST_P(ClosedShapes, AreWatertightOnePieceAndFaceOutward) {
  const Mesh& mesh = GetParam().mesh;
  const TopologyReport report = inspect(mesh.topology.triangles, mesh.positions.size());
  EXPECT_TRUE(support::watertight(report));
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  const EdgeSet edges = collect_edges(mesh.topology.triangles);
  EXPECT_EQ(count(mesh.positions) - count(edges.edges) + count(mesh.topology.triangles), GetParam().euler);
  EXPECT_GT(volume(mesh), 0);
}

TEST_P(ClosedShapes, HaveNoTriangleWithoutArea) {
  EXPECT_GT(worst_triangle(GetParam().mesh), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ClosedShapes, testing::ValuesIn(closed_shapes()),
                         [](const auto& shape) { return shape.param.name; });

TEST(Sphere, HasItsVerticesOnTheSphereAndReachesItOnAllAxes) {
  for (const int segments : {3, 20, 48, 100}) {
    const Mesh sphere = make_sphere(0.3, segments);
    for (const Vec3& x : sphere.positions) EXPECT_NEAR(x.norm(), 0.3, kRoundingOfSums);
    const Box3 box = bounding_box(sphere.positions);
    EXPECT_NEAR((box.max() - Vec3::Constant(0.3)).norm() + (box.min() + Vec3::Constant(0.3)).norm(), 0,
                kRoundingOfSums);
  }
}

TEST(Sphere, IsConvexAndMissesNoMoreVolumeThanOutsideTheBallItHolds) {
  for (const int segments : {3, 24, 48}) {
    const Mesh sphere = make_sphere(1, segments);
    EXPECT_LT(bulge_over_faces(sphere), kRoundingOfSums);
    double depth = 1;  // distance of the nearest face: the convex polyhedron contains a ball of this radius
    for (const Triangle& t : sphere.topology.triangles) {
      depth = std::min(depth, area_vector(t, sphere.positions).normalized().dot(sphere.positions[t[0]]));
    }
    EXPECT_LT(volume(sphere), 4 * kPi / 3);
    EXPECT_GT(volume(sphere), 4 * kPi / 3 * depth * depth * depth);
  }
}

TEST(Sphere, LosesAQuarterOfItsDeficitPerDoubling) {
  const auto deficit = [](int segments) { return 4 * kPi / 3 - volume(make_sphere(1, segments)); };
  EXPECT_NEAR(deficit(42) / deficit(84), 4, 0.05);  // second order in the edge length
}

TEST(Sphere, HasWellShapedTriangles) {
  EXPECT_GT(worst_triangle(make_sphere(1, 48)), 0.65);  // measured: 0.69
}

TEST(Sphere, HasAboutTheSegmentsAskedFor) {
  for (const int segments : {10, 24, 48, 100}) {
    const Mesh sphere = make_sphere(1, segments);
    const EdgeSet set = collect_edges(sphere.topology.triangles);
    const auto corner = [&](const Edge& edge, std::size_t k) { return sphere.positions[edge.vertices[k]]; };
    double sum = 0;
    for (const Edge& edge : set.edges) sum += (corner(edge, 1) - corner(edge, 0)).norm();
    // Number of edges of mean length that fit into the circumference; it changes in steps of 10.5.
    EXPECT_NEAR(2 * kPi / (sum / static_cast<double>(set.edges.size())), segments, 5.5) << segments;
  }
}

TEST(Box, HasItsSizesVolumeAndTwelveTriangles) {
  const Mesh box = make_box({1, 2, 3}, 0, 48);
  EXPECT_EQ(box.topology.triangles.size(), 12u);
  EXPECT_NEAR(volume(box), 6, kRoundingOfSums);
  const Box3 bounds = bounding_box(box.positions);
  EXPECT_EQ(Vec3(bounds.min()), Vec3(-0.5, -1, -1.5));
  EXPECT_EQ(Vec3(bounds.max()), Vec3(0.5, 1, 1.5));
}

TEST(Box, WithOneBevelFaceLosesPrismsAtEdgesAndTetrahedraAtCorners) {
  const double b = 0.1;
  const Mesh box = make_box({1, 2, 3}, b, 8);
  // The bevel removes a prism with the cross-section b²/2 from each edge. From the cube b³ at each corner, it leaves a
  // tetrahedron of b³/6.
  const double edges = 4 * (1 + 2 + 3 - 3 * 2 * b) * b * b / 2;
  EXPECT_NEAR(volume(box), 6 - edges - 8 * (b * b * b * 5 / 6), kRoundingOfSums);
  EXPECT_LT(bulge_over_faces(box), kRoundingOfSums);
}

TEST(Box, WithManyBevelFacesConvergesToTheRoundedBox) {
  const double b = 0.1;
  const Vec3 inner(1 - 2 * b, 2 - 2 * b, 3 - 2 * b);
  // Steiner's formula: inner box, slabs on its faces, quarter cylinders at its edges, and parts of a ball at its
  // corners.
  const double rounded = inner.prod() +
                         2 * b * (inner.x() * inner.y() + inner.y() * inner.z() + inner.z() * inner.x()) +
                         kPi * b * b * inner.sum() + 4 * kPi / 3 * b * b * b;
  const auto deficit = [&](int segments) { return rounded - volume(make_box({1, 2, 3}, b, segments)); };
  EXPECT_GT(deficit(128), 0);
  EXPECT_NEAR(deficit(64) / deficit(128), 4, 0.1);  // the error of inscribed polyhedra is of second order
  const Box3 bounds = bounding_box(make_box({1, 2, 3}, b, 48).positions);
  EXPECT_NEAR((bounds.sizes() - Vec3(1, 2, 3)).norm(), 0, kRoundingOfSums);
}

TEST(Box, RoundsItsEdgesInEqualSteps) {
  const double b = 0.1;
  int on_edge = 0;
  for (const Vec3& x : make_box({1, 2, 3}, b, 48).positions) {  // six steps of 15 degrees
    const double y = x.y() - (1 - b), z = x.z() - (1.5 - b);
    if (std::abs(x.x() - (0.5 - b)) > kRoundingOfSums || y < -kRoundingOfSums || z < -kRoundingOfSums) continue;
    const double steps = std::atan2(z, y) * 12 / kPi;
    EXPECT_NEAR(steps, std::round(steps), kRoundingOfSums);
    EXPECT_NEAR(std::hypot(y, z), b, kRoundingOfSums);
    ++on_edge;
  }
  EXPECT_EQ(on_edge, 7);
}

TEST(Cylinder, IsThePrismOverItsPolygon) {
  for (const int segments : {3, 13, 48}) {
    const Mesh cylinder = make_cylinder(0.5, 2, segments);
    EXPECT_NEAR(volume(cylinder), polygon(segments) * 0.25 * 2, kRoundingOfSums);
    EXPECT_LT(bulge_over_faces(cylinder), kRoundingOfSums);
    const Box3 bounds = bounding_box(cylinder.positions);
    EXPECT_EQ(bounds.min().z(), -1);
    EXPECT_EQ(bounds.max().z(), 1);
    EXPECT_EQ(bounds.max().x(), 0.5);
  }
}

TEST(Cylinder, AsAThinBarHasNoMoreRowsThanSegments) {
  EXPECT_EQ(make_cylinder(0.005, 2, 16).topology.triangles.size(), 2u * 16 * 16 + 2 * (2 * 3 - 1) * 16);
}

TEST(Cone, IsThePyramidOverItsPolygonWithItsTipUp) {
  for (const int segments : {3, 13, 48}) {
    const Mesh cone = make_cone(0.5, 2, segments);
    EXPECT_NEAR(volume(cone), polygon(segments) * 0.25 * 2 / 3, kRoundingOfSums);
    EXPECT_LT(bulge_over_faces(cone), kRoundingOfSums);
    EXPECT_EQ(std::count(cone.positions.begin(), cone.positions.end(), Vec3(0, 0, 1)), 1);
  }
}

TEST(Torus, HasTheVolumeOfItsTurnedPolygon) {
  const double radius = 0.5, tube = 0.2;
  const Mesh torus = make_torus(radius, tube, 48);
  // The width of a cell at the outer equator fits 13.7 times around the tube; the program takes the nearest multiple of
  // four.
  const int around_tube = 12;
  ASSERT_EQ(torus.positions.size(), 48u * around_tube);
  // Pappus: volume = length of the path of the centroid times area. With 48 steps in place of a circle, the factor is 2
  // polygon(48) in place of 2 π.
  EXPECT_NEAR(volume(torus), 2 * polygon(48) * radius * polygon(around_tube) * tube * tube, kRoundingOfSums);
  for (const Vec3& x : torus.positions)
    EXPECT_NEAR(std::hypot(std::hypot(x.x(), x.y()) - radius, x.z()), tube, kRoundingOfSums);
}

TEST(HalfPipe, IsAHalfRingOpenUpwardAlongX) {
  const Mesh pipe = make_half_pipe(1, 2, 0.25, 40);
  EXPECT_NEAR(volume(pipe), 0.5 * polygon(40) * (1.25 * 1.25 - 1) * 2, kRoundingOfSums);
  const Box3 bounds = bounding_box(pipe.positions);
  EXPECT_NEAR((bounds.min() - Vec3(-1, -1.25, -1.25)).norm(), 0, kRoundingOfSums);
  EXPECT_NEAR((bounds.max() - Vec3(1, 1.25, 0)).norm(), 0, kRoundingOfSums);
  for (const Vec3& x : pipe.positions) {
    const double r = std::hypot(x.y(), x.z());
    EXPECT_LT(std::min(std::abs(r - 1), std::abs(r - 1.25)), kRoundingOfSums);
  }
}

TEST(Plane, IsOneQuadFacingUp) {
  const Mesh plane = make_plane({4, 6});
  EXPECT_EQ(plane.topology.quads.size(), 1u);
  ASSERT_EQ(plane.topology.triangles.size(), 2u);
  for (const Triangle& t : plane.topology.triangles) EXPECT_EQ(area_vector(t, plane.positions), Vec3(0, 0, 12));
  const Box3 bounds = bounding_box(plane.positions);
  EXPECT_EQ(Vec3(bounds.min()), Vec3(-2, -3, 0));
  EXPECT_EQ(Vec3(bounds.max()), Vec3(2, 3, 0));
}

}  // namespace
}  // namespace weft::mesh
