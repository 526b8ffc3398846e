#include "physics/mesh/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/mesh/geometry.hpp"

namespace weft::mesh {
namespace {

// Tolerance: rounding errors of a sum of about ten areas near one.
constexpr double kRoundingOfAreas = 1e-14;

std::vector<Triangle> triangulate(const std::vector<Vec3>& corners,
                                  decltype(triangulate_polygon)* method = triangulate_polygon) {
  std::vector<Index> indices;
  for (std::size_t k = 0; k < corners.size(); ++k) indices.push_back(static_cast<Index>(k));
  std::vector<Triangle> triangles;
  method(indices, corners, triangles);
  return triangles;
}

/// Expects n - 2 triangles that cover the area, none of them inverted.
void expect_covered(const std::vector<Vec3>& corners, double area, const Vec3& normal) {
  for (auto* method : {triangulate_polygon, triangulate_face}) {
    const std::vector<Triangle> triangles = triangulate(corners, method);
    EXPECT_EQ(triangles.size(), corners.size() - 2);
    EXPECT_NEAR(surface_area(triangles, corners), area, kRoundingOfAreas);
    for (const Triangle& t : triangles) EXPECT_GE(area_vector(t, corners).dot(normal), 0);
    EXPECT_TRUE(inspect(triangles, corners.size()).manifold());
  }
}

TEST(Polygon, OfThreeCornersIsItself) {
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Polygon, OfFewerCornersGivesNothing) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
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
  // No corner belongs to more than 2 log2(n) triangles, the bound of recursive halving.
  std::vector<int> around(n);
  for (const Triangle& triangle : triangulate(corners))
    for (const Index v : triangle) ++around[v];
  for (const int count : around) EXPECT_LE(count, 10);
}

/// Expects each corner to be in a triangle of non-zero area.
void expect_each_corner_kept(const std::vector<Vec3>& corners) {
  std::vector<int> kept(corners.size());
  for (const Triangle& t : triangulate(corners, triangulate_face)) {
    const double longest = std::max({(corners[t[1]] - corners[t[0]]).norm(), (corners[t[2]] - corners[t[1]]).norm(),
                                     (corners[t[0]] - corners[t[2]]).norm()});
    if (area_vector(t, corners).norm() > 1e-4 * longest * longest)
      for (const Index v : t) ++kept[v];
  }
  EXPECT_EQ(std::ranges::count(kept, 0), 0) << "of " << corners.size();
}

// Some programs write a row of cells as one face. Coordinates are rounded to single precision, as in files.
TEST(Polygon, WithCornersAlongStraightSidesKeepsThemAll) {
  for (const int along : {4, 13, 40})
    for (const double angle : {0.0, 0.3, 1.1}) {
      const Quat turn(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()));
      std::vector<Vec3> corners;
      const auto add = [&](double x, double y) {
        corners.push_back((turn * Vec3(x - 0.3, y - 0.2, 0.1)).cast<float>().cast<double>());
      };
      for (int i = 0; i < along; ++i) add(0.025 * i, 0);
      for (int i = 0; i < along; ++i) add(0.025 * (along - 1 - i), 0.025);
      expect_each_corner_kept(corners);
      double flattest = 1;
      for (const Triangle& t : triangulate(corners, triangulate_face)) {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
          longest = std::max(longest, (corners[t[(k + 1) % 3]] - corners[t[k]]).norm());
        flattest = std::min(flattest, 2 * area_vector(t, corners).norm() / (longest * longest));
      }
      EXPECT_GT(flattest, along > 4 ? 0.3 : 0.1)
          << "halves of squares have 0.5, with " << along << " corners along a side";
      // A square with this number of corners along each side.
      corners.clear();
      const double size = 0.025 * along;
      for (int i = 0; i < along; ++i) add(0.025 * i, 0);
      for (int i = 0; i < along; ++i) add(size, 0.025 * i);
      for (int i = 0; i < along; ++i) add(size - 0.025 * i, size);
      for (int i = 0; i < along; ++i) add(0, size - 0.025 * i);
      expect_each_corner_kept(corners);
    }
}

TEST(Polygon, ThatCrossesItselfOrHasCollapsedStillEnds) {
  for (auto* method : {triangulate_polygon, triangulate_face}) {
    EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}}, method).size(), 3u);
    EXPECT_EQ(triangulate(std::vector<Vec3>(7, Vec3(1, 2, 3)), method).size(), 5u);
    EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, method).size(), 3u);
  }
}

}  // namespace
}  // namespace weft::mesh
