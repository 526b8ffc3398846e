// Sheets of triangles and their material coordinates.
#include "physics/mesh/sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/mesh/geometry.hpp"

namespace weft::mesh {
namespace {

const Grid kGrid{.nu = 4, .nv = 3, .lu = 0.5, .lv = 0.25};

TEST(TriangleSheet, PatternsCoverTheGridOnceAndFaceUp) {
  for (const auto& [pattern, vertices, triangles] :
       {std::tuple{Pattern::aligned, 12u, 12u}, std::tuple{Pattern::crossed, 18u, 24u}}) {
    const Mesh sheet = make_triangle_sheet(kGrid, pattern);
    EXPECT_TRUE(sheet.topology.quads.empty());
    EXPECT_EQ(sheet.positions.size(), vertices);
    EXPECT_EQ(sheet.topology.triangles.size(), triangles);
    double area = 0;
    for (const Triangle& t : sheet.topology.triangles) {
      EXPECT_GT(area_vector(t, sheet.positions).z(), 0);
      area += area_vector(t, sheet.positions).z();
    }
    EXPECT_DOUBLE_EQ(area, 1.5 * 0.5);
    EXPECT_TRUE(inspect(sheet.topology.triangles, vertices).manifold());
    for (std::size_t i = 0; i < vertices; ++i)
      EXPECT_LT((sheet.positions[i] - Vec3(sheet.uv[i].x() - 0.75, sheet.uv[i].y() - 0.25, 0)).norm(), 1e-15);
  }
}

TEST(TriangleSheet, FlatOnesHaveWeftAlongXAndWarpAlongY) {
  const Mesh mesh = make_triangle_sheet(kGrid, Pattern::crossed);
  const Sheet sheet = make_sheet_from_mesh(mesh);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = mesh.positions[sheet.triangles[t][k]];
      EXPECT_LT((sheet.material[t][k] - Vec2(x.x(), x.y())).norm(), 1e-15);
    }
}

TEST(TriangleSheet, MaterialCoordinatesKeepLengthsHoweverTheTriangleIsTurned) {
  Mesh mesh = make_triangle_sheet(kGrid, Pattern::aligned);
  for (const Vec3& axis : {Vec3(1, 2, -3), Vec3(0, 1, 0), Vec3(1, 0, 0)})
    for (double angle : {0.3, M_PI / 2, 2.5}) {
      Mesh turned = mesh;
      for (Vec3& x : turned.positions) x = Eigen::AngleAxisd(angle, axis.normalized()) * x;
      const Sheet sheet = make_sheet_from_mesh(turned);
      for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
        const auto& m = sheet.material[t];
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(
              (m[(k + 1) % 3] - m[k]).norm(),
              (turned.positions[sheet.triangles[t][(k + 1) % 3]] - turned.positions[sheet.triangles[t][k]]).norm(),
              1e-15);
        const Vec2 a = m[1] - m[0], b = m[2] - m[0];
        EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
      }
    }
}

TEST(TriangleSheet, LeastHeightIsThatOfTheNarrowestTriangle) {
  const Sheet sheet = make_sheet_from_mesh(make_triangle_sheet(kGrid, Pattern::aligned));
  // Height above the hypotenuse of a triangle with legs 0.5 and 0.25.
  EXPECT_NEAR(min_height(sheet), 0.125 / std::hypot(0.5, 0.25), 1e-15);
}

}  // namespace
}  // namespace weft::mesh
