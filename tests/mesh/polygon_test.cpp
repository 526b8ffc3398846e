#include "mesh/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/geometry.hpp"

namespace weft::mesh {
namespace {

// Sums of some ten rounded areas near one.
constexpr double kRoundingOfAreas = 1e-14;

std::vector<Triangle> cut(const std::vector<Vec3>& corners) {
  std::vector<Index> indices;
  for (std::size_t k = 0; k < corners.size(); ++k) indices.push_back(static_cast<Index>(k));
  std::vector<Triangle> triangles;
  triangulate_polygon(indices, corners, triangles);
  return triangles;
}

/// Expects n - 2 triangles that cover the area without turning over.
void expect_covered(const std::vector<Vec3>& corners, double area, const Vec3& normal) {
  const std::vector<Triangle> triangles = cut(corners);
  EXPECT_EQ(triangles.size(), corners.size() - 2);
  EXPECT_NEAR(surface_area(triangles, corners), area, kRoundingOfAreas);
  for (const Triangle& t : triangles) EXPECT_GE(area_vector(t, corners).dot(normal), 0);
  EXPECT_TRUE(inspect(triangles, corners.size()).manifold());
}

TEST(Polygon, OfThreeCornersIsItself) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Polygon, OfFewerCornersGivesNothing) {
  EXPECT_TRUE(cut({}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(Polygon, WithNotchesIsCoveredFromEveryStartAndEitherSide) {
  std::vector<Vec3> comb{{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {4, 2, 0}, {4, 1, 0}, {3, 1, 0},
                         {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (std::size_t start = 0; start < comb.size(); ++start) {
    expect_covered(comb, 8, Vec3(0, 0, 1));
    const std::vector<Vec3> seen_from_behind(comb.rbegin(), comb.rend());
    expect_covered(seen_from_behind, 8, Vec3(0, 0, -1));
    std::rotate(comb.begin(), comb.begin() + 1, comb.end());
  }
}

TEST(Polygon, InAnyPlaneIsCovered) {
  const Quat turn(Eigen::AngleAxisd(2.2, Vec3(1, -2, 0.7).normalized()));
  std::vector<Vec3> corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (Vec3& x : corners) x = turn * x + Vec3(3, 4, 5);
  expect_covered(corners, 3, turn * Vec3(0, 0, 1));
}

TEST(Polygon, ThatIsRegularIsCutWithoutAFan) {
  std::vector<Vec3> corners;
  const int n = 32;
  for (int k = 0; k < n; ++k)
    corners.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), 0);
  expect_covered(corners, 0.5 * n * std::sin(2 * std::numbers::pi / n), Vec3(0, 0, 1));
  // No corner carries more than the 2 log2(n) triangles of a halving cut.
  std::vector<int> around(n);
  for (const Triangle& triangle : cut(corners))
    for (const Index v : triangle) ++around[v];
  for (const int count : around) EXPECT_LE(count, 10);
}

TEST(Polygon, ThatCrossesItselfOrHasCollapsedStillEnds) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}}).size(), 3u);
  EXPECT_EQ(cut(std::vector<Vec3>(7, Vec3(1, 2, 3))).size(), 5u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size(), 3u);
}

}  // namespace
}  // namespace weft::mesh
