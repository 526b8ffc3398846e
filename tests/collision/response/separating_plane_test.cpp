// Tests of separating planes that turn with two triangles during a step. separation_exact_test.cpp compares separating
// planes with exact predicates, for random motions.
#include "physics/collision/response/separating_plane.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace weft::collision {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr CornerPair kPair{{0, 1, 2}, {3, 4, 5}};

/// Two triangles, 12 mm wide, one 1 mm above the other.
std::vector<Vec3> layers() {
  std::vector<Vec3> x;
  for (const double z : {1e-3, 0.0})
    for (const Vec3& corner : {Vec3(-6e-3, -4e-3, z), Vec3(6e-3, -4e-3, z), Vec3(0, 8e-3, z)}) x.push_back(corner);
  return x;
}

std::vector<Vec3> turned(std::vector<Vec3> x, double angle) {
  const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(1, 2, 0).normalized()).toRotationMatrix();
  for (Vec3& place : x) place = turn * place;
  return x;
}

/// Whether one of 10,000 constant directions, spread over the sphere, separates the triangles for the whole step.
bool any_direction_separates(const std::vector<Vec3>& x_t0, const std::vector<Vec3>& x_t1) {
  constexpr int kDirections = 10'000;
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1 - (2 * k + 1.0) / kDirections, around = k * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    if (separates(Vec3(r * std::cos(around), r * std::sin(around), z), kPair, x_t0, x_t1)) return true;
  }
  return false;
}

// A separating plane turns with the layers by up to 90 degrees. For larger angles, the step is divided.
TEST(SeparatingPlane, LayersThatTurnTogetherHaveAPlaneThatTurnsWithThem) {
  for (const double angle : {20.0, 45.0, 80.0, 100.0, 140.0}) {
    SCOPED_TRACE(angle);
    const std::vector<Vec3> x_t0 = layers(), x_t1 = turned(x_t0, angle * kDegree);
    const auto found = find_separating_plane(kPair, x_t0, x_t1);
    ASSERT_TRUE(found);
    EXPECT_NEAR(gap_along(*found, kPair, x_t1), 1e-3, 1e-9) << "the direction is that of the end";
    EXPECT_FALSE(any_direction_separates(x_t0, x_t1));
  }
}

TEST(SeparatingPlane, LayersThatTurnAndPassThroughEachOtherHaveNone) {
  for (const double angle : {0.0, 20.0, 45.0, 80.0, 100.0, 140.0}) {
    SCOPED_TRACE(angle);
    std::vector<Vec3> x_t0 = layers(), x_t1 = x_t0;
    for (std::size_t v = 0; v < 3; ++v) x_t1[v].z() = -1e-3;
    EXPECT_FALSE(find_separating_plane(kPair, x_t0, turned(x_t1, angle * kDegree)));
  }
}

TEST(SeparatingPlane, LayersThatHardlyTurnNeedNoPlaneThatTurns) {
  const std::vector<Vec3> x_t0 = layers(), x_t1 = turned(x_t0, 2 * kDegree);
  const auto found = find_separating_plane(kPair, x_t0, x_t1);
  ASSERT_TRUE(found);
  EXPECT_TRUE(separates(*found, kPair, x_t0, x_t1));
}

}  // namespace
}  // namespace weft::collision
