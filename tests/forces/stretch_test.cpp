// Tension along weft and warp.
#include "physics/forces/stretch.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::kHeight;
using testing::kWidth;
using testing::Positions;

Positions stretched(double along_u, double along_v) {
  return testing::shaped(kGrid, [=](double u, double v) { return Vec3(along_u * u, along_v * v, 0); });
}

TEST(Stretch, UniformStrainHasTheEnergyOfTheContinuum) {
  const Stretch stretch(kGrid, 0, {1000, 700, 0});
  for (double strain : {-0.1, 0.02, 0.3}) {
    const double expected = 0.5 * kWidth * kHeight * (1000 * strain * strain + 700 * 4 * strain * strain);
    EXPECT_NEAR(stretch.energy(stretched(1 + strain, 1 + 2 * strain)), expected, 1e-12 * expected);
  }
}

TEST(Stretch, BorderOfAUniformlyStrainedSheetPullsWithTheStressTimesItsWidth) {
  const Stretch stretch(kGrid, 0, {1000, 700, 0});
  const Positions x = stretched(1.03, 0.98);
  const Positions f = testing::force_of(stretch, x, testing::zeros(x));
  Vec3 left = Vec3::Zero(), low = Vec3::Zero();
  for (int j = 0; j < kGrid.nv; ++j) left += f[kGrid.index(0, j)];
  for (int i = 0; i < kGrid.nu; ++i) low += f[kGrid.index(i, 0)];
  EXPECT_NEAR(left.x(), 1000 * 0.03 * kHeight, 1e-12);
  EXPECT_NEAR(low.y(), -700 * 0.02 * kWidth, 1e-12);
  // Inside the sheet, the forces of both sides of a particle cancel.
  EXPECT_LT(f[kGrid.index(2, 1)].norm(), 1e-12);
}

TEST(Stretch, ViscosityOpposesTheStrainRate) {
  const double eta = 5, rate = 0.4;  // [N·s/m], [1/s]
  const Stretch stretch(kGrid, 0, {0, 0, eta});
  const Positions x = testing::flat(kGrid);
  const Positions v = testing::shaped(kGrid, [=](double u, double) { return Vec3(rate * u, 0, 0); });
  const Positions f = testing::force_of(stretch, x, v);
  Vec3 right = Vec3::Zero();
  for (int j = 0; j < kGrid.nv; ++j) right += f[kGrid.index(kGrid.nu - 1, j)];
  EXPECT_NEAR(right.x(), -eta * rate * kHeight, 1e-12);
  EXPECT_NEAR(right.y(), 0, 1e-14);
}

TEST(Stretch, CollapsedEdgePullsNowhereAndStaysFinite) {
  Stretch stretch(kGrid, 0, {1000, 700, 5});
  Positions x = testing::flat(kGrid);
  x[1] = x[0];
  const Positions v = testing::random_vectors(x.size(), 1, 1);
  EXPECT_TRUE(testing::dense(testing::force_of(stretch, x, v)).allFinite());
  EXPECT_TRUE(testing::jacobian_of(stretch, x, v, 100).allFinite());
  EXPECT_TRUE(testing::stiffness_of(stretch, x, v, 100).allFinite());
}

TEST(Stretch, LargestStrainIsFoundInTensionAndInCompression) {
  const Stretch stretch(kGrid, 0, {1000, 700, 0});
  EXPECT_NEAR(stretch.max_strain(testing::flat(kGrid)), 0, 1e-14);
  EXPECT_NEAR(stretch.max_strain(stretched(1.03, 1.01)), 0.03, 1e-13);
  EXPECT_NEAR(stretch.max_strain(stretched(1.03, 0.9)), 0.1, 1e-13);
}

TEST(Stretch, StrainOfAParticleIsTheLargestOfItsOwnEdges) {
  const Stretch stretch(kGrid, 3, {1000, 700, 0});
  Positions x(3, Vec3::Zero());
  const Positions sheet = testing::flat(kGrid);
  x.insert(x.end(), sheet.begin(), sheet.end());
  // Moves the corner at (0, 0) outward by half an edge along weft.
  x[3].x() -= 0.5 * kGrid.lu;
  std::vector<float> heat(sheet.size(), 0);
  stretch.strain_per_particle(x, heat);
  const double warp_edge = std::hypot(kGrid.lv, 0.5 * kGrid.lu) / kGrid.lv - 1;
  EXPECT_NEAR(heat[0], 0.5, 1e-6);
  EXPECT_NEAR(heat[1], 0.5, 1e-6);
  EXPECT_NEAR(heat[kGrid.index(0, 1)], warp_edge, 1e-6);
  EXPECT_NEAR(heat[kGrid.index(1, 1)], 0, 1e-6);
}

TEST(Stretch, DefiniteFormLeavesOutWhatCompressionSoftens) {
  Stretch stretch(mesh::Grid{2, 2, 0.1, 0.1}, 0, {1000, 0, 0});
  const auto positions = [](double length) {
    return Positions{{0, 0, 0}, {length, 0, 0}, {0, 0.1, 0}, {length, 0.1, 0}};
  };
  const auto across = [&](double length) {
    const Positions x = positions(length);
    return testing::stiffness_of(stretch, x, testing::zeros(x), 0)(2, 2);
  };
  const auto exactly_across = [&](double length) {
    const Positions x = positions(length);
    return testing::jacobian_of(stretch, x, testing::zeros(x), 0)(2, 2);
  };
  const double along = 500;  // stiffness k A / l² of an edge with half a spacing of width [N/m]
  EXPECT_NEAR(exactly_across(0.08), -0.25 * along, 1e-9);
  EXPECT_NEAR(across(0.08), 0, 1e-9);
  EXPECT_NEAR(exactly_across(0.01), -9 * along, 1e-9);
  EXPECT_NEAR(across(0.01), 0, 1e-9);
}

}  // namespace
}  // namespace weft::forces
