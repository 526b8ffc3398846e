// Bending of the sheet as a plate.
#include "physics/forces/bend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kRigidity;
using testing::Positions;

constexpr double kRadius = 0.2;  // [m]

/// A sheet of 0.2 m by 0.15 m bent to a cylinder; its axis is at `angle` to the warp.
Positions cylinder(const mesh::Grid& grid, double angle) {
  return testing::shaped(grid, [=](double u, double v) {
    const double along = u * std::cos(angle) + v * std::sin(angle);
    const double across = -u * std::sin(angle) + v * std::cos(angle);
    return Vec3(kRadius * std::sin(along / kRadius), across, kRadius * (1 - std::cos(along / kRadius)));
  });
}

mesh::Grid grid_of(int cells) {
  return {4 * cells + 1, 3 * cells + 1, 0.05 / cells, 0.05 / cells};
}

TEST(Bend, PlaneHasNoBendForceHoweverItsParticlesLie) {
  // The sheet is stretched and sheared, but stays in a plane.
  const mesh::Grid grid = grid_of(2);
  const Bend bend(grid, 0, {kRigidity, 1e-5});
  const Positions x = testing::moved_rigidly(
      testing::shaped(grid, [](double u, double v) { return Vec3(1.3 * u + 0.2 * v, 0.9 * v, 0); }));
  const Positions v = testing::rigid_velocities(x);
  // Tolerance: coordinates of metres have rounding errors of 4e-16 m; the force multiplies them by B / l² = 0.5 N/m and
  // sums up about 30 terms.
  EXPECT_LT(testing::largest(testing::force_of(bend, x, v)), 1e-14);
  EXPECT_LT(bend.energy(x), 1e-28);
}

TEST(Bend, CylinderHasTheEnergyOfThePlateToSecondOrder) {
  // The end particles of a thread have no second difference. The energy of curvature along weft therefore omits half a
  // spacing at either end of the weft, and along warp likewise; the twist is measured in the cells and omits nothing.
  for (double angle : {0.0, std::numbers::pi / 4, std::numbers::pi / 2}) {
    const auto error_at = [&](int cells) {
      const mesh::Grid grid = grid_of(cells);
      const double width = (grid.nu - 1) * grid.lu, height = (grid.nv - 1) * grid.lv;
      const double c = std::cos(angle), s = std::sin(angle);
      const double area = c * c * c * c * (width - grid.lu) * height + 2 * c * c * s * s * width * height +
                          s * s * s * s * width * (height - grid.lv);
      const double expected = 0.5 * kRigidity * area / (kRadius * kRadius);
      return std::abs(Bend(grid, 0, {kRigidity, 0}).energy(cylinder(grid, angle)) / expected - 1);
    };
    for (int cells : {2, 4}) {
      // On a circle, a second difference is too small by the fraction l² / 12 R², and the energy by twice that. If the
      // threads are oblique to the axis, the error is smaller.
      const double l = grid_of(cells).lu;
      EXPECT_LT(error_at(cells), 1.01 * l * l / (6 * kRadius * kRadius));
      EXPECT_NEAR(std::log2(error_at(cells) / error_at(2 * cells)), 2, 0.02) << "angle " << angle;
    }
  }
}

TEST(Bend, ParabolaHasTheEnergyOfThePlateOnAGradedGridToRounding) {
  // Second differences of parabolas are exact for any spacing. The energy of curvature omits half a spacing at either
  // end of each thread; the energy of twist, which is measured in the cells, covers the whole sheet.
  mesh::Grid grid = grid_of(2);
  grid.weft_grading = 5, grid.warp_grading = 0.5;
  const double width = grid.u(grid.nu - 1), height = grid.v(grid.nv - 1);
  const double inner_u = width - grid.width_u(0) - grid.width_u(grid.nu - 1);
  const double inner_v = height - grid.width_v(0) - grid.width_v(grid.nv - 1);
  const double uu = 3, uv = 2, vv = -4;
  const Positions x = testing::shaped(
      grid, [&](double u, double v) { return Vec3(u, v, 0.5 * uu * u * u + uv * u * v + 0.5 * vv * v * v); });
  const double expected =
      0.5 * kRigidity * (uu * uu * inner_u * height + 2 * uv * uv * width * height + vv * vv * width * inner_v);
  EXPECT_NEAR(Bend(grid, 0, {kRigidity, 0}).energy(x), expected, 1e-12 * expected);
}

TEST(Bend, CylinderApproachesHalfBAOverRSquaredAsTheGridIsRefined) {
  const auto error_at = [](int cells) {
    const mesh::Grid grid = grid_of(cells);
    const double expected = 0.5 * kRigidity * 0.2 * 0.15 / (kRadius * kRadius);
    return 1 - Bend(grid, 0, {kRigidity, 0}).energy(cylinder(grid, 0)) / expected;
  };
  // The error is of first order, because the energy omits half a spacing at either free end: together 1/8 and 1/64 of
  // the length.
  EXPECT_NEAR(error_at(2), 1.0 / 8, 0.005);
  EXPECT_NEAR(error_at(16), 1.0 / 64, 0.0005);
}

TEST(Bend, RestoresTowardsThePlane) {
  const mesh::Grid grid = grid_of(1);
  const Bend bend(grid, 0, {kRigidity, 0});
  Positions x = testing::flat(grid);
  const auto middle = static_cast<std::size_t>(grid.index(2, 1));
  x[middle].z() += 0.01;
  const Positions f = testing::force_of(bend, x, testing::zeros(x));
  EXPECT_LT(f[middle].z(), 0);
  EXPECT_NEAR(f[middle].x(), 0, 1e-16);
  // One inner particle is raised by 1 mm. The forces are −B Δ²z l², where the 13-point stencil of Δ² has the weights
  // 20 / l⁴ at its centre, −8 / l⁴ at the neighbours and 1 / l⁴ two particles away.
  const mesh::Grid large = grid_of(3);
  Positions spike = testing::flat(large);
  const auto centre = static_cast<std::size_t>(large.index(6, 4));
  spike[centre].z() += 0.001;
  const Positions g = testing::force_of(Bend(large, 0, {kRigidity, 0}), spike, testing::zeros(spike));
  const double unit = kRigidity * 0.001 / (large.lu * large.lu);
  EXPECT_NEAR(g[centre].z(), -20 * unit, 1e-12 * unit);
  EXPECT_NEAR(g[centre + 1].z(), 8 * unit, 1e-12 * unit);
  EXPECT_NEAR(g[centre + 2].z(), -unit, 1e-12 * unit);
}

TEST(Bend, FrictionIsAMomentOfConstantSizeAgainstTheChangeOfCurvature) {
  // The curvature of a cylinder changes, at rates far above and far below BendDamping::kStickRate = 0.5 1/(m·s), at
  // which friction reaches 0.7 of its full size.
  constexpr double kFriction = 3e-3;
  const Bend bend(testing::kGrid, 0, BendParameters{0, 0, kFriction});
  const double curvature = 2;
  const auto cylinder = [&](double c) {
    return testing::shaped(testing::kGrid,
                           [&](double u, double v) { return Vec3(std::sin(c * u) / c, v, (1 - std::cos(c * u)) / c); });
  };
  const testing::Positions x = cylinder(curvature);
  const auto power = [&](double rate) {
    constexpr double kTime = 1e-6;
    const testing::Positions before = cylinder(curvature - 0.5 * kTime * rate),
                             after = cylinder(curvature + 0.5 * kTime * rate);
    testing::Positions v = x;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = (after[i] - before[i]) / kTime;
    const testing::Positions f = testing::force_of(bend, x, v);
    double sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += f[i].dot(v[i]);
    return sum;
  };
  // Second differences need a neighbour on either side, so the area is one cell shorter than the sheet along weft.
  const mesh::Grid& grid = testing::kGrid;
  const double area = grid.lu * (grid.nu - 2) * grid.lv * (grid.nv - 1);
  for (double rate : {50.0, -50.0}) {
    // Tolerance: kStickRate reduces the power by the fraction (0.5 / 50)² / 2, and kFlatCurvature by (0.1 / 2)² / 2.
    EXPECT_NEAR(power(rate), -kFriction * area * std::abs(rate), 2e-3 * kFriction * area * std::abs(rate)) << rate;
  }
  // At rates far below kStickRate, the power is quadratic in the rate.
  EXPECT_NEAR(power(0.005) / power(0.0005), 100, 0.1);
}

}  // namespace
}  // namespace weft::forces
