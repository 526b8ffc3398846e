#include "film/render/depth_raster.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace weft::render {
namespace {

constexpr int kSize = 64;

std::vector<float> fill(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  std::vector<float> depths(kSize * kSize, 9.0f);
  fill_triangle(a, b, c, kSize, kSize, [&](int at, bool covered, float depth, float, float) {
    if (covered) depths[at] = depth;
  });
  return depths;
}

// If the centre of a texel is on the inner side of all three edges, the texel must have the depth of the triangle's
// plane; otherwise, it must keep its initial value 9. Tests both orientations of the triangle.
TEST(DepthRaster, CoversTheTexelsWhoseCentresLieInsideAndGivesThemTheDepthOfThePlane) {
  const Eigen::Vector3f a(3.2f, 5.1f, 0.1f), b(60.7f, 20.3f, 0.5f), c(17.9f, 58.6f, 0.9f);
  for (const bool turned : {false, true}) {
    const std::vector<float> depths = turned ? fill(a, c, b) : fill(a, b, c);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const auto side = [&](const auto& p, const auto& q) {
          return (q.x() - p.x()) * (py - p.y()) - (q.y() - p.y()) * (px - p.x());
        };
        const double area = side(a, b) + side(b, c) + side(c, a);
        const double depth = (side(b, c) * a.z() + side(c, a) * b.z() + side(a, b) * c.z()) / area;
        const bool inside = side(a, b) > 0 && side(b, c) > 0 && side(c, a) > 0;
        EXPECT_NEAR(depths[y * kSize + x], inside ? depth : 9, 1e-5) << x << " " << y;
      }
    }
  }
}

TEST(DepthRaster, WhatReachesOutOfTheMapIsCutOff) {
  const std::vector<float> depths = fill({-500, -500, 0.5f}, {500, -500, 0.5f}, {0, 900, 0.5f});
  for (const float depth : depths) EXPECT_EQ(depth, 0.5f);
  // These corners are beyond the range of int.
  for (const float depth : fill({-1e10f, -1e10f, 0.5f}, {1e10f, -1e10f, 0.5f}, {0, 2e10f, 0.5f}))
    EXPECT_EQ(depth, 0.5f);
  for (const float depth : fill({70, 3, 0}, {90, 3, 0}, {80, 30, 0})) EXPECT_EQ(depth, 9);
}

// The near plane is z = w, here z = 1, which halves an edge from z = 0 to z = 2. If one corner is behind the plane, 3/4
// of the area remain; if two corners are behind it, 1/4.
TEST(DepthRaster, ClippingLeavesWhatLiesInFrontOfTheNearPlane) {
  const auto area_left = [](double z_a, double z_b, double z_c) {
    double area = 0;
    clip_near({Eigen::Vector4d(0, 0, z_a, 1), Eigen::Vector4d(2, 0, z_b, 1), Eigen::Vector4d(0, 2, z_c, 1)},
              [&](const auto& p, const auto& q, const auto& r) {
                EXPECT_LE(std::max({p.z(), q.z(), r.z()}), 1 + 1e-12);
                area += 0.5 * ((q.x() - p.x()) * (r.y() - p.y()) - (r.x() - p.x()) * (q.y() - p.y()));
              });
    return area;
  };
  EXPECT_NEAR(area_left(0, 0, 0), 2, 1e-12);
  EXPECT_NEAR(area_left(2, 0, 0), 1.5, 1e-12);
  EXPECT_NEAR(area_left(2, 2, 0), 0.5, 1e-12);
  EXPECT_EQ(area_left(2, 2, 2), 0);
}

}  // namespace
}  // namespace weft::render
