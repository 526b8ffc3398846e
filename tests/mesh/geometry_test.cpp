#include "physics/mesh/geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/mesh/shapes.hpp"
#include "support/mesh_measures.hpp"

namespace weft::mesh {
namespace {

// Tolerance: ten rounding errors of numbers near one.
constexpr double kRounding = 1e-15;

const std::vector<Triangle> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
const std::vector<Vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};

TEST(Area, OfATetrahedronIsThatOfItsFourSides) {
  const double slanted = 0.5 * Vec3(6, 3, 2).norm();  // half the cross product of two of its sides
  EXPECT_NEAR(surface_area(kTetrahedron, kCorners), 1 + 1.5 + 3 + slanted, 10 * kRounding);
}

TEST(Volume, OfATetrahedronIsASixthOfItsBoxAndNegativeInsideOut) {
  EXPECT_NEAR(support::enclosed_volume(kTetrahedron, kCorners), 1, kRounding);
  auto inside_out = kTetrahedron;
  for (Triangle& t : inside_out) std::swap(t[0], t[1]);
  EXPECT_NEAR(support::enclosed_volume(inside_out, kCorners), -1, kRounding);
}

TEST(Volume, OfATinyBodyFarFromTheOriginKeepsItsDigits) {
  // The size is a third of a millimetre, rounded so that adding the distance is exact: only the sum can lose digits.
  const double size = std::round(std::ldexp(1.0 / 3, 30)) * std::ldexp(1.0, -40);
  auto far = kCorners;
  for (Vec3& x : far) x = size * x + Vec3(1024, -2048, 4096);
  EXPECT_NEAR(support::enclosed_volume(kTetrahedron, far) / (size * size * size), 1, kRounding);
}

TEST(VertexNormals, WeighTrianglesByTheirArea) {
  // Two perpendicular triangles share the vertices 0 and 2: one of area 2 faces +z, one of area 1 faces +x.
  const std::vector<Vec3> x{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  std::vector<Vec3> normals(4);
  vertex_normals(triangles, x, normals);
  EXPECT_LT((normals[0] - Vec3(1, 0, 2).normalized()).norm(), kRounding);
  EXPECT_EQ(normals[1], Vec3(0, 0, 1));
  EXPECT_EQ(normals[3], Vec3(1, 0, 0));
}

TEST(VertexNormals, OfLooseVerticesAndFlatTrianglesAreZero) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  std::vector<Vec3> normals(4, Vec3::Ones());
  vertex_normals(std::vector<Triangle>{{0, 1, 2}}, x, normals);
  for (const Vec3& normal : normals) EXPECT_EQ(normal, Vec3(0, 0, 0));
}

TEST(VertexNormals, OfATinySphereStillHaveUnitLength) {
  const Mesh sphere = make_sphere(1e-6, 24);
  std::vector<Vec3> normals(sphere.positions.size());
  vertex_normals(sphere.topology.triangles, sphere.positions, normals);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_NEAR(normals[v].norm(), 1, kRounding);
    // This geodesic sphere is regular enough for normals within 3 degrees of the radius.
    EXPECT_GT(normals[v].dot(sphere.positions[v].normalized()), std::cos(3 * M_PI / 180));
  }
}

TEST(BoundingBox, TouchesTheExtremePointsAndIsEmptyWithoutPoints) {
  const Box3 box = bounding_box(kCorners);
  EXPECT_EQ(Vec3(box.min()), Vec3(0, 0, 0));
  EXPECT_EQ(Vec3(box.max()), Vec3(1, 2, 3));
  EXPECT_TRUE(bounding_box({}).isEmpty());
}

}  // namespace
}  // namespace weft::mesh
