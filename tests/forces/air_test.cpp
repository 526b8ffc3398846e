// Air resistance.
#include "physics/forces/air.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::Positions;

constexpr double kRho = 1.2, kDrag = 0.8;

Positions drag_on(const Positions& x, const Positions& v, const Vec3& wind = Vec3::Zero()) {
  return testing::force_of(Air(kGrid, 0, {kRho, wind, kDrag}), x, v);
}

Vec3 sum(const Positions& f) {
  Vec3 total = Vec3::Zero();
  for (const Vec3& force : f) total += force;
  return total;
}

const double kArea = (kGrid.nu - 1) * kGrid.lu * (kGrid.nv - 1) * kGrid.lv;

TEST(Air, SheetThatMovesAlongItsNormalIsHeldBackByTheQuadraticLaw) {
  const Positions x = testing::flat(kGrid);
  for (double speed : {-8.0, 0.1, 3.0}) {
    const Vec3 total = sum(drag_on(x, Positions(x.size(), Vec3(0, 0, speed))));
    const double expected = -0.5 * kRho * kDrag * kArea * std::abs(speed) * speed;
    EXPECT_NEAR(total.z(), expected, 1e-13 * std::abs(expected));
    EXPECT_EQ(total.x(), 0);
    EXPECT_EQ(total.y(), 0);
  }
}

TEST(Air, MotionInThePlaneOfTheSheetMeetsNone) {
  const Positions x = testing::flat(kGrid);
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), Vec3(3, -4, 0)))), 0);
}

TEST(Air, ForceIsAlongTheNormalOfASlantedSheet) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid));
  const Vec3 n = (x[1] - x[0]).cross(x[5] - x[0]).normalized(), v(1, 2, -4);
  const Vec3 total = sum(drag_on(x, Positions(x.size(), v)));
  EXPECT_LT(total.cross(n).norm(), 1e-12 * total.norm());
  const double speed = v.dot(n);
  EXPECT_NEAR(total.dot(n), -0.5 * kRho * kDrag * kArea * std::abs(speed) * speed, 1e-12 * total.norm());
}

TEST(Air, OnlyTheMotionAgainstTheAirCounts) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid));
  const Vec3 wind(2, -1, 5);
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), wind), wind)), 0);
  const Positions still = drag_on(x, testing::zeros(x), wind);
  const Positions moving = drag_on(x, Positions(x.size(), -wind));
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((still[i] - moving[i]).norm(), 1e-15);
  // Wind pushes in its own direction.
  EXPECT_GT(sum(still).dot(wind), 0);
}

TEST(Air, RangesOfParticlesAddUpToTheSameBits) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid)), v = testing::random_vectors(x.size(), 2, 1);
  Air air(kGrid, 0, {kRho, Vec3(1, 2, 0), kDrag});
  testing::expect_same_bits_in_ranges(air, x, v, 50);
}

TEST(Air, MatrixIsThatOfAMotionOfAllCornersTogetherAndNoLessOfAnyOther) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid)), v = testing::random_vectors(x.size(), 2, 1);
  const double rate = 50;
  Air air(kGrid, 0, {kRho, Vec3(1, 2, 0), kDrag});
  const Eigen::MatrixXd matrix = testing::stiffness_of(air, x, v, rate);
  const auto force_at = [&](const Positions& velocities) { return testing::force_of(air, x, velocities); };
  constexpr double kEpsilon = 1e-6;
  for (unsigned trial = 0; trial < 6; ++trial) {
    // Changes all velocities by the same vector, or each by its own.
    Positions change = testing::random_vectors(x.size(), 1, 2 + trial);
    if (trial < 3) change.assign(x.size(), change[0]);
    Positions after = v, before = v;
    for (std::size_t i = 0; i < x.size(); ++i) after[i] += kEpsilon * change[i], before[i] -= kEpsilon * change[i];
    const Positions f_after = force_at(after), f_before = force_at(before);
    const auto direction = testing::dense(change);
    const double of_matrix = direction.dot(matrix * direction);
    const double of_force = rate * direction.dot(testing::dense(f_before) - testing::dense(f_after)) / (2 * kEpsilon);
    // For equal changes of all velocities, the matrix is the exact derivative. Tolerance: the central difference has
    // errors of order ε², and rounding errors divided by ε.
    if (trial < 3)
      EXPECT_NEAR(of_matrix, of_force, 1e-6 * of_matrix);
    else
      EXPECT_GT(of_matrix, of_force);
  }
}

TEST(Air, SheetWithoutAreaIsLeftAlone) {
  const Positions x(static_cast<std::size_t>(kGrid.size()), Vec3(1, 2, 3));
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), Vec3(0, 0, 5)))), 0);
}

}  // namespace
}  // namespace weft::forces
