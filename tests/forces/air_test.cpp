// Air resistance.
#include "forces/air.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::Positions;

constexpr double kRho = 1.2, kDrag = 0.8;

Positions drag_on(const Positions& x, const Positions& v, double h, const Vec3& wind = Vec3::Zero(),
                  double density = 0.2, Air::Taken taken = Air::Taken::over_the_step) {
  Positions f = testing::zeros(x);
  Air(kGrid, 0, {kRho, wind, kDrag}).add(x, v, lumped_masses(kGrid, density), h, taken, f);
  return f;
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
    const Vec3 total = sum(drag_on(x, Positions(x.size(), Vec3(0, 0, speed)), 0));
    const double expected = -0.5 * kRho * kDrag * kArea * std::abs(speed) * speed;
    EXPECT_NEAR(total.z(), expected, 1e-13 * std::abs(expected));
    EXPECT_EQ(total.x(), 0);
    EXPECT_EQ(total.y(), 0);
  }
}

TEST(Air, MotionInThePlaneOfTheSheetMeetsNone) {
  const Positions x = testing::flat(kGrid);
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), Vec3(3, -4, 0)), 0.01)), 0);
}

TEST(Air, ForceIsAlongTheNormalOfASlantedSheet) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid));
  const Vec3 n = (x[1] - x[0]).cross(x[5] - x[0]).normalized(), v(1, 2, -4);
  const Vec3 total = sum(drag_on(x, Positions(x.size(), v), 0));
  EXPECT_LT(total.cross(n).norm(), 1e-12 * total.norm());
  const double speed = v.dot(n);
  EXPECT_NEAR(total.dot(n), -0.5 * kRho * kDrag * kArea * std::abs(speed) * speed, 1e-12 * total.norm());
}

TEST(Air, OnlyTheMotionAgainstTheAirCounts) {
  const Positions x = testing::moved_rigidly(testing::flat(kGrid));
  const Vec3 wind(2, -1, 5);
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), wind), 0.01, wind)), 0);
  const Positions still = drag_on(x, testing::zeros(x), 0.01, wind);
  const Positions moving = drag_on(x, Positions(x.size(), -wind), 0.01);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((still[i] - moving[i]).norm(), 1e-15);
  // Wind pushes the way it blows.
  EXPECT_GT(sum(still).dot(wind), 0);
}

TEST(Air, InnerParticleSlowsDownAsTheExactSolutionDoes) {
  // m v' = −c v² for the share of one cell: c = ½ ρ drag A, m = density A.
  const Positions x = testing::flat(kGrid);
  const double density = 0.05, area = kGrid.lu * kGrid.lv, v0 = 6;
  const double c = 0.5 * kRho * kDrag * area, m = density * area;
  // All four cells around this particle have only inner particles or borders; those inside are the grid's middle.
  const mesh::Grid large{7, 7, kGrid.lu, kGrid.lv};
  const Positions sheet = testing::flat(large);
  for (double h : {0.001, 0.1, 10.0}) {
    Positions f = testing::zeros(sheet);
    Air(large, 0, {kRho, Vec3::Zero(), kDrag})
        .add(sheet, Positions(sheet.size(), Vec3(0, 0, v0)), lumped_masses(large, density), h,
             Air::Taken::over_the_step, f);
    const double v1 = v0 + h * f[large.index(3, 3)].z() / m;
    EXPECT_NEAR(v1, v0 / (1 + h * c * v0 / m), 1e-12 * v0) << "h = " << h;
  }
}

TEST(Air, AtAMomentIsTheLawButForTheSquareOfTheStep) {
  const Positions x = testing::flat(kGrid), v(x.size(), Vec3(0, 0, 3));
  const auto drag = [&](double h) { return sum(drag_on(x, v, h, Vec3::Zero(), 0.2, Air::Taken::at_that_moment)).z(); };
  const double law = drag(0), missing = 1 - drag(0.02) / law;
  EXPECT_NEAR(law, -0.5 * kRho * kDrag * kArea * 9, 1e-13 * std::abs(law));
  // z = 0.14 here; the next term is z² / 4 of this one.
  EXPECT_GT(missing, 0.008);
  EXPECT_NEAR((1 - drag(0.01) / law) / missing, 0.25, 0.01);
}

TEST(Air, NeverTurnsAMotionRoundHoweverLongTheStepAndLightTheCloth) {
  const Positions x = testing::flat(kGrid);
  for (auto taken : {Air::Taken::over_the_step, Air::Taken::at_that_moment})
    for (double density : {1e-4, 0.01, 1.0})
      for (double h : {1e-3, 1.0, 1e3})
        for (double speed : {-50.0, 0.1, 50.0}) {
          const Positions f = drag_on(x, Positions(x.size(), Vec3(0, 0, speed)), h, Vec3::Zero(), density, taken);
          const auto masses = lumped_masses(kGrid, density);
          for (std::size_t i = 0; i < x.size(); ++i) {
            const double after = speed + h * f[i].z() / masses[i];
            EXPECT_GE(after * speed, -1e-12 * speed * speed) << "particle " << i;
            EXPECT_LT(std::abs(after), std::abs(speed));
          }
        }
}

TEST(Air, SheetWithoutAreaIsLeftAlone) {
  const Positions x(static_cast<std::size_t>(kGrid.size()), Vec3(1, 2, 3));
  EXPECT_EQ(testing::largest(drag_on(x, Positions(x.size(), Vec3(0, 0, 5)), 0.01)), 0);
}

}  // namespace
}  // namespace weft::forces
