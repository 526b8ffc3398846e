#include "physics/mesh/isosurface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/mesh/geometry.hpp"
#include "physics/mesh/topology.hpp"
#include "support/mesh_measures.hpp"

namespace weft::mesh {
namespace {

double sphere(const Vec3& p) {
  return p.norm() - 0.5;
}
double torus(const Vec3& p) {
  return std::hypot(std::hypot(p.x(), p.y()) - 0.5, p.z()) - 0.2;
}

Mesh half_of(const Field& field, double cell) {
  return march_half_space(field, Box3(Vec3::Constant(-0.8), Vec3::Constant(0.8)), cell);
}

TEST(Isosurface, BorderLiesInThePlaneAndNowhereElse) {
  for (const Field& field : {Field(sphere), Field(torus)}) {
    Mesh half = half_of(field, 0.05);
    for (int round = 0; round < 2; ++round) {
      const auto report = inspect(half.topology.triangles, half.positions.size());
      EXPECT_TRUE(report.manifold());
      EXPECT_FALSE(report.border.empty());
      std::size_t in_plane = 0;
      for (const Vec3& p : half.positions) {
        EXPECT_GE(p.x(), 0);
        in_plane += p.x() == 0 ? 1 : 0;
      }
      EXPECT_EQ(in_plane, report.border.size());  // closed lines have as many vertices as edges
      for (const auto& edge : report.border) {
        for (const Index v : edge) EXPECT_EQ(half.positions[v].x(), 0);
      }
      remesh(
          half, field, [](const Vec3&) { return 0.06; }, 6);
    }
  }
}

TEST(Isosurface, MirroredSurfaceIsClosedAndItsImageListAnInvolution) {
  const MirroredMesh whole = join_mirror_image(half_of(torus, 0.06));
  EXPECT_TRUE(support::watertight(inspect(whole.mesh.topology.triangles, whole.mesh.positions.size())));
  const auto edges = collect_edges(whole.mesh.topology.triangles).edges.size();
  EXPECT_EQ(whole.mesh.positions.size() + whole.mesh.topology.triangles.size(), edges) << "a torus has one hole";
  for (std::size_t v = 0; v < whole.image.size(); ++v) {
    const auto other = static_cast<std::size_t>(whole.image[v]);
    EXPECT_EQ(static_cast<std::size_t>(whole.image[other]), v);
    EXPECT_EQ(whole.mesh.positions[other], whole.mesh.positions[v].cwiseProduct(Vec3(-1, 1, 1)));
  }
}

TEST(Isosurface, RemeshedSphereHasEvenTrianglesOnTheSurface) {
  Mesh half = half_of(sphere, 0.05);
  remesh(
      half, sphere, [](const Vec3&) { return 0.05; }, 8);
  const MirroredMesh whole = join_mirror_image(half);
  const auto& triangles = whole.mesh.topology.triangles;
  const auto& x = whole.mesh.positions;
  EXPECT_TRUE(support::watertight(inspect(triangles, x.size())));
  for (const Vec3& p : x) EXPECT_NEAR(p.norm(), 0.5, 1e-9);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = x[t[k]], b = x[t[(k + 1) % 3]], c = x[t[(k + 2) % 3]];
      EXPECT_GT((b - a).norm(), 0.5 * 0.05);
      EXPECT_LT((b - a).norm(), 1.5 * 0.05);
      EXPECT_GT(std::acos((b - a).normalized().dot((c - a).normalized())), 25 * std::numbers::pi / 180);
    }
  }
  // A polyhedron that is inscribed into a sphere and has edges of 0.1 r lacks a few thousandths of the volume.
  EXPECT_NEAR(support::enclosed_volume(triangles, x), std::numbers::pi / 6, 0.005);
}

TEST(Isosurface, FollowsASizeThatChanges) {
  Mesh half = half_of(sphere, 0.03);
  const Sizing size = [](const Vec3& p) { return 0.04 + 0.04 * (p.z() + 0.5); };
  remesh(half, sphere, size, 8);
  double ratio = 0;
  const auto edges = collect_edges(half.topology.triangles).edges;
  for (const Edge& e : edges) {
    const Vec3 &a = half.positions[e.vertices[0]], &b = half.positions[e.vertices[1]];
    const double r = (a - b).norm() / size(0.5 * (a + b));
    EXPECT_GT(r, 0.45);
    EXPECT_LT(r, 1.6);
    ratio += r / static_cast<double>(edges.size());
  }
  EXPECT_NEAR(ratio, 1, 0.1);
}

}  // namespace
}  // namespace weft::mesh
