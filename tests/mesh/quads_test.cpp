#include "physics/mesh/quads.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/mesh/geometry.hpp"

namespace weft::mesh {
namespace {

using Triangles = std::vector<Triangle>;

const Triangles kFirstDiagonal{{0, 1, 2}, {0, 2, 3}};
const Triangles kSecondDiagonal{{0, 1, 3}, {1, 2, 3}};
const std::vector<Quad> kQuad{{0, 1, 2, 3}};

TEST(QuadSplit, TakesTheShorterDiagonal) {
  EXPECT_EQ(split_quads(kQuad, std::vector<Vec3>{{0, 0, 0}, {2, -1, 0}, {3, 0, 0}, {2, 1, 0}}), kSecondDiagonal);
  EXPECT_EQ(split_quads(kQuad, std::vector<Vec3>{{2, -1, 0}, {3, 0, 0}, {2, 1, 0}, {0, 0, 0}}), kFirstDiagonal);
}

TEST(QuadSplit, TakesTheFirstDiagonalOnATie) {
  EXPECT_EQ(split_quads(kQuad, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), kFirstDiagonal);
}

TEST(QuadSplit, StaysInsideAnArrowheadEvenIfThatDiagonalIsLonger) {
  // The reflex corner is corner 3 at (0, -0.5). Its diagonal, to corner 1, has length 3.5. The other diagonal lies
  // outside, and has length 2.
  const std::vector<Vec3> arrow{{-1, 0, 0}, {0, -4, 0}, {1, 0, 0}, {0, -0.5, 0}};
  EXPECT_EQ(split_quads(kQuad, arrow), kSecondDiagonal);
}

TEST(QuadSplit, GivesQuadQTheTriangles2qAnd2qPlus1) {
  const std::vector<Quad> quads{{0, 1, 2, 3}, {1, 4, 5, 2}};
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0.5, 0}, {2, 1, 0}};
  EXPECT_EQ(split_quads(quads, x), (Triangles{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}, {4, 5, 2}}));
}

TEST(Sheet, IsCentredWithWeftAlongXAndWarpAlongY) {
  const Grid grid{.nu = 3, .nv = 4, .lu = 0.5, .lv = 0.25};
  const Mesh sheet = make_sheet(grid);
  ASSERT_EQ(sheet.positions.size(), 12u);
  ASSERT_EQ(sheet.uv.size(), 12u);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(grid.index(i, j));
      EXPECT_EQ(sheet.positions[k], Vec3(0.5 * i - 0.5, 0.25 * j - 0.375, 0));
      EXPECT_EQ(sheet.uv[k], Vec2(0.5 * i, 0.25 * j));
    }
  }
}

TEST(Sheet, OfAGradedGridHasSpacingsThatGrowByOneFactor) {
  const Grid grid{.nu = 5, .nv = 4, .lu = 0.75, .lv = 0.5, .weft_grading = 8, .warp_grading = 0.25};
  const Mesh sheet = make_sheet(grid);
  // Weft spacings: 0.2 m · (1 + 2 + 4 + 8) = 4 · 0.75 m. Warp spacings: 3/7 m · (2 + 1 + 1/2) = 3 · 0.5 m.
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(sheet.uv[i].x(), 0.2 * ((1 << i) - 1), 1e-15);
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(sheet.uv[5 * j].y(), 12.0 / 7 * (1 - std::pow(0.5, j)), 1e-15);
  for (std::size_t k = 0; k < sheet.uv.size(); ++k)
    EXPECT_LT((sheet.positions[k] - Vec3(sheet.uv[k].x() - 1.5, sheet.uv[k].y() - 0.75, 0)).norm(), 1e-15);
  EXPECT_NEAR(grid.min_spacing(), 0.2, 1e-15);
}

TEST(Grid, WidthsAreThoseOfTheNeighbouringHalvesAndAddUpToTheSheet) {
  const Grid grid{.nu = 5, .nv = 4, .lu = 0.75, .lv = 0.5, .weft_grading = 8, .warp_grading = 0.25};
  double weft = 0, warp = 0;
  for (int i = 0; i < 5; ++i) weft += grid.width_u(i);
  for (int j = 0; j < 4; ++j) warp += grid.width_v(j);
  EXPECT_NEAR(weft, 3, 1e-15);
  EXPECT_NEAR(warp, 1.5, 1e-15);
  EXPECT_NEAR(grid.width_u(0), 0.1, 1e-15);
  EXPECT_NEAR(grid.width_u(1), 0.3, 1e-15);
  EXPECT_NEAR(grid.width_u(4), 0.8, 1e-15);
}

TEST(Sheet, AlternatesItsDiagonalsAndFacesUp) {
  const Grid grid{.nu = 3, .nv = 3, .lu = 1, .lv = 1};
  const Mesh sheet = make_sheet(grid);
  EXPECT_EQ(sheet.topology.quads, (std::vector<Quad>{{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}));
  EXPECT_EQ(sheet.topology.triangles,
            (Triangles{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4}, {3, 4, 6}, {4, 7, 6}, {4, 5, 8}, {4, 8, 7}}));
  for (const Triangle& t : sheet.topology.triangles) EXPECT_EQ(area_vector(t, sheet.positions), Vec3(0, 0, 0.5));
}

}  // namespace
}  // namespace weft::mesh
