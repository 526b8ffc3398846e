#include "film/render/shaded_mesh.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/error.hpp"
#include "film/image/color.hpp"
#include "film/render/renderer.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

ShadedMesh shade_all(const frame::FrameSnapshot& snapshot, double crease_angle) {
  const auto& triangles = snapshot.surfaces[0]->triangles;
  const auto& positions = snapshot.states[0].positions;
  return make_shaded_mesh(triangles, CornerMap(triangles, positions.size()), positions, crease_angle);
}

/// Largest error of the vertex normals of a sphere with n rings, except near the poles.
double worst_sphere_normal(int n) {
  frame::FrameSnapshot snapshot;
  const Vec3 center(0.3, -0.2, 0.5);
  add_sphere(snapshot, center, 0.7, n);
  const ShadedMesh mesh = shade_all(snapshot, 180);
  double worst = 0;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    const Vec3 radial = (snapshot.states[0].positions[mesh.source[v]] - center) / 0.7;
    // Toward the poles, the triangles around a vertex are unequal, and the error is of first order.
    if (std::abs(radial.z()) < 0.7) worst = std::max(worst, (mesh.normals[v] - radial).norm());
  }
  return worst;
}

// The error is of second order: half the mesh width gives a quarter of it. Measured 0.0088 at n = 24; the limit is
// twice that.
TEST(ShadedMesh, NormalsOfASphereAreRadialToSecondOrder) {
  const double coarse = worst_sphere_normal(24), fine = worst_sphere_normal(48);
  EXPECT_LT(coarse, 0.018);
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
}

std::vector<std::array<Index, 3>> cube_triangles() {
  return {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
}

frame::FrameSnapshot cube() {
  frame::FrameSnapshot snapshot;
  std::vector<Vec3> positions;
  for (int i = 0; i < 8; ++i) positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  add_surface(snapshot, frame::ObjectKind::obstacle, positions, cube_triangles());
  return snapshot;
}

TEST(ShadedMesh, CubeHasThreeNormalsAtEachCornerWhereItsEdgesAreCreases) {
  const ShadedMesh mesh = shade_all(cube(), 30);
  ASSERT_EQ(mesh.normals.size(), 24u);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    // All three corners have the normal of the face, and the vertices are those of the cube.
    EXPECT_EQ(mesh.normals[a], mesh.normals[b]);
    EXPECT_EQ(mesh.normals[a], mesh.normals[c]);
    EXPECT_EQ(mesh.normals[a].cwiseAbs().maxCoeff(), 1);
    EXPECT_EQ(mesh.source[a], cube_triangles()[t][0]);
    EXPECT_EQ(mesh.source[b], cube_triangles()[t][1]);
    EXPECT_EQ(mesh.source[c], cube_triangles()[t][2]);
  }
  const ShadedMesh smooth = shade_all(cube(), 91);
  EXPECT_EQ(smooth.normals.size(), 8u);
}

TEST(ShadedMesh, TrianglesWithoutAreaGiveUnitNormals) {
  frame::FrameSnapshot snapshot;
  add_surface(snapshot, frame::ObjectKind::cloth, {Vec3::Zero(), Vec3::Zero(), Vec3::UnitX(), 2 * Vec3::UnitX()},
              {{0, 1, 2}, {0, 2, 3}, {3, 3, 3}});
  for (const double crease : {180.0, 30.0}) {
    for (const Vec3& normal : shade_all(snapshot, crease).normals) EXPECT_EQ(normal, Vec3::UnitZ());
  }
}

TEST(ShadedMesh, TriangleNamingAMissingVertexIsAnError) {
  const std::vector<Triangle> triangles{{0, 1, 3}};
  EXPECT_THROW(CornerMap(triangles, 3), Error);
  const std::vector<Triangle> negative{{0, 1, -1}};
  EXPECT_THROW(CornerMap(negative, 3), Error);
}

TEST(ShadedMesh, OnlyASurfaceWithoutBordersIsClosed) {
  const std::vector<Triangle> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_TRUE(is_closed(tetrahedron));
  EXPECT_FALSE(is_closed(std::span(tetrahedron).first(3)));
  // The first triangle is inverted.
  EXPECT_FALSE(is_closed(std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  // The last triangle occurs twice.
  EXPECT_FALSE(is_closed(std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {2, 0, 3}}));
  EXPECT_FALSE(is_closed({}));
}

// A sphere of 16 columns; the border between its lit (left) and dark half is in the middle of the picture. Light is
// evaluated on the smooth sphere; otherwise, coarse faces would shadow themselves where they still face the light.
TEST(ShadedMesh, LightFallsEvenlyToTheDarkSideOfFewFaces) {
  frame::FrameSnapshot snapshot;
  snapshot.stage = stage_without_sky();
  add_sphere(snapshot, Vec3::Zero(), 0.5, 8).crease_angle = 180;
  snapshot.cameras = {camera_at(Vec3(0, -4, 0), Vec3::Zero(), 16)};
  snapshot.lights = {sun(Vec3::UnitX())};
  Settings settings;
  settings.width = 320;
  settings.height = 320;
  const image::Image image = Renderer(settings).draw(snapshot);
  // The radius is 142 pixels. Columns with a cosine below 0.08 are excluded, because direct light fades out below 0.06.
  for (int x = 70; x < 148; ++x) {
    const double cosine = (160 - (x + 0.5)) / 142;
    const Vec3 shown = image::srgb_from_linear(cosine * image::linear_from_srgb(Vec3::Constant(0.8)));
    EXPECT_NEAR(image.pixel(x, 160)[1], 255 * shown.x(), 14) << x;
  }
}

}  // namespace
}  // namespace weft::render
