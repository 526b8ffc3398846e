// Shear between weft and warp.
#include "physics/forces/shear.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::Positions;

constexpr double kModulus = 80;  // [N/m]

TEST(Shear, UniformShearHasTheEnergyOfTheContinuum) {
  const Shear shear(kGrid, 0, {kModulus, 0});
  const double area = (kGrid.nu - 1) * kGrid.lu * (kGrid.nv - 1) * kGrid.lv;
  for (double g : {0.01, 0.4}) {
    // The derivatives s_u = (1, 0, 0) and s_v = (g, 1, 0) have the product ⟨s_u, s_v⟩ = g.
    const Positions x = testing::shaped(kGrid, [=](double u, double v) { return Vec3(u + g * v, v, 0); });
    const double expected = 0.25 * kModulus * g * g * area;
    EXPECT_NEAR(shear.energy(x), expected, 1e-12 * expected);
  }
}

TEST(Shear, StressOfASmoothSurfaceConvergesWithSlopeTwo) {
  // A curved and sheared surface around the point (0.3, 0.2); ⟨s_u, s_v⟩ there follows from its derivatives.
  const auto surface = [](double u, double v) {
    return Vec3(u + 0.2 * std::sin(2 * v + u), v + 0.1 * u * v * v, 0.3 * std::cos(3 * u) * std::sin(2 * v));
  };
  const double u = 0.3, v = 0.2;
  const double c = std::cos(2 * v + u);
  const Vec3 su(1 + 0.2 * c, 0.1 * v * v, -0.9 * std::sin(3 * u) * std::sin(2 * v));
  const Vec3 sv(0.4 * c, 1 + 0.2 * u * v, 0.6 * std::cos(3 * u) * std::cos(2 * v));
  const double exact = 0.5 * kModulus * su.dot(sv);

  // One cell around the point. Its stress ½ μ ⟨s_u, s_v⟩ follows from its energy ¼ μ ⟨s_u, s_v⟩² A.
  const auto error_at = [&](double l) {
    const mesh::Grid cell{2, 2, l, l};
    const Positions x =
        testing::shaped(cell, [&](double a, double b) { return surface(u + a - 0.5 * l, v + b - 0.5 * l); });
    const double stress = std::sqrt(kModulus * Shear(cell, 0, {kModulus, 0}).energy(x)) / l;
    return std::abs(stress - std::abs(exact));
  };
  for (double l : {0.04, 0.02, 0.01})
    // Tolerance: the next term of the error, of order l⁴, is less than 1 % of the first.
    EXPECT_NEAR(std::log2(error_at(l) / error_at(l / 2)), 2, 0.02) << "l = " << l;
}

TEST(Shear, ViscosityOpposesTheRateOfShear) {
  const double eta = 3, rate = 0.7;
  const Shear shear(kGrid, 0, {0, eta});
  const Positions x = testing::flat(kGrid);
  const Positions v = testing::shaped(kGrid, [=](double, double b) { return Vec3(rate * b, 0, 0); });
  const Positions f = testing::force_of(shear, x, v);
  // Stress ½ η d/dt⟨s_u, s_v⟩ acts along weft on the upper border.
  Vec3 top = Vec3::Zero();
  for (int i = 0; i < kGrid.nu; ++i) top += f[kGrid.index(i, kGrid.nv - 1)];
  EXPECT_NEAR(top.x(), -0.5 * eta * rate * (kGrid.nu - 1) * kGrid.lu, 1e-13);
}

TEST(Shear, StripesThatDifferencesOverTwoEdgesMissAreSheared) {
  Positions x = testing::flat(kGrid);
  for (int j = 0; j < kGrid.nv; ++j)
    for (int i = 0; i < kGrid.nu; ++i) x[kGrid.index(i, j)].y() += i % 2 ? 1e-3 : -1e-3;
  // Along each weft edge of 20 mm, y changes by ±2e-3 m: ⟨s_u, s_v⟩ = ±0.1 in every cell.
  const double area = (kGrid.nu - 1) * kGrid.lu * (kGrid.nv - 1) * kGrid.lv;
  EXPECT_NEAR(Shear(kGrid, 0, {kModulus, 0}).energy(x), 0.25 * kModulus * 0.01 * area, 1e-12);
}

TEST(Shear, NoPatternInThePlaneEscapesStretchAndShearTogether) {
  Stretch stretch(kGrid, 0, {1000, 700, 0});
  Shear shear(kGrid, 0, {kModulus, 0});
  const Positions x = testing::flat(kGrid), still = testing::zeros(x);
  const Eigen::MatrixXd k = testing::jacobian_of(stretch, x, still, 0) + testing::jacobian_of(shear, x, still, 0);
  const auto count = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd plane(2 * count, 2 * count);
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b) plane.block<2, 2>(2 * a, 2 * b) = k.block<2, 2>(3 * a, 3 * b);
  const Eigen::VectorXd values = plane.selfadjointView<Eigen::Lower>().eigenvalues();  // ascending
  // Only two translations and a rotation have no stiffness.
  EXPECT_LT(values.head<3>().cwiseAbs().maxCoeff(), 1e-12 * values.maxCoeff());
  EXPECT_GT(values[3], 1e-3 * values.maxCoeff());
}

}  // namespace
}  // namespace weft::forces
