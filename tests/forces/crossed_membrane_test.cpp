// The membrane of crossed cells: exact for affine states, and equal to TriangleMembrane in flat parallelograms.
#include "physics/forces/crossed_membrane.hpp"

#include <gtest/gtest.h>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::kStiffness;
using testing::Positions;

mesh::Sheet crossed_sheet() {
  return mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::crossed));
}

StretchParameters stretch(double viscosity) {
  return {kStiffness, 0.7 * kStiffness, viscosity};
}
ShearParameters shear(double viscosity) {
  return {0.3 * kStiffness, 0.5 * viscosity};
}

bool is_middle(std::size_t i) {
  return i >= static_cast<std::size_t>(kGrid.nu * kGrid.nv);
}

/// Moves each particle by up to `size` [m] along each axis.
Positions crumpled(const mesh::Sheet& sheet, double size) {
  return testing::shaken(sheet.rest, size, 5);
}

/// Deforms the cells to parallelograms in their plane. Moves each middle particle in the plane by up to `size` [m]
/// along each axis.
Positions parallelograms(const mesh::Sheet& sheet, double size) {
  Positions x = sheet.rest;
  const Positions noise = testing::random_vectors(x.size(), size, 5);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 at = sheet.rest[i];
    x[i] += Vec3(0.1 * at.x() + 0.2 * at.y(), -0.05 * at.x() - 0.1 * at.y(), 0);
    if (is_middle(i)) x[i] += Vec3(noise[i].x(), noise[i].y(), 0);
  }
  return x;
}

/// Shears each cell until its area is `area_ratio` times that at rest, and moves each particle by up to 1 mm.
Positions fold_up(const mesh::Sheet& sheet, double area_ratio) {
  Positions x = crumpled(sheet, 0.001);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3& at = sheet.rest[i];
    x[i] += Vec3(std::sqrt(1 - area_ratio * area_ratio) * at.y(), (area_ratio - 1) * at.y(), 0);
  }
  return x;
}

TEST(CrossedMembrane, ForceIsMinusTheGradientOfTheEnergy) {
  const mesh::Sheet sheet = crossed_sheet();
  const CrossedMembrane membrane(sheet, 0, stretch(0), shear(0));
  for (const Positions& x : {crumpled(sheet, 0.006), fold_up(sheet, 0.6), fold_up(sheet, 0.2)}) {
    testing::expect_forces_from_energy(membrane, x, 1e-7, 1e-7);
    const Positions f = testing::force_of(membrane, x, testing::zeros(x));
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) sum += f[i], moment += x[i].cross(f[i]);
    EXPECT_LT(sum.norm(), 2e-12 * testing::largest(f));
    EXPECT_LT(moment.norm(), 2e-12 * testing::largest(f));
  }
}

// The corners span only 1e-6 of the area of the cell at rest. Below the fraction kFoldedSize = 0.5 of this area,
// CrossedMembrane shortens the normal: here to 1e-6 / (½ · 0.5) = 4e-6 instead of 1. Its forces thus differ from those
// of the triangles by a few times 1e-6 of stiffness × cell width.
TEST(CrossedMembrane, IsThatOfItsTrianglesWhereCellsAreFoldedUp) {
  const mesh::Sheet sheet = crossed_sheet();
  const CrossedMembrane crossed(sheet, 0, stretch(0), shear(0));
  const TriangleMembrane plain(sheet, 0, stretch(0), shear(0));
  Positions x = sheet.rest;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3& at = sheet.rest[i];
    x[i] = {at.x() + at.y(), 1e-6 * at.y(), is_middle(i) ? 0.002 : 0};
  }
  const Positions a = testing::force_of(crossed, x, testing::zeros(x)),
                  b = testing::force_of(plain, x, testing::zeros(x));
  double largest = 0;
  for (const Vec3& force : b) largest = std::max(largest, force.norm());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((a[i] - b[i]).norm(), 1e-5 * largest);
}

// If a cell folds about a diagonal, its threads keep their lengths.
TEST(CrossedMembrane, LetsThreadsAtOppositeSidesOfACellBeSkew) {
  const mesh::Sheet sheet =
      mesh::make_sheet_from_mesh(mesh::make_triangle_sheet({2, 2, 0.02, 0.02}, mesh::Pattern::crossed));
  const CrossedMembrane crossed(sheet, 0, stretch(0), shear(0));
  Positions x = sheet.rest;
  const double angle = 0.8, half = 0.02 * std::sqrt(0.5);
  // Corners in the order of the grid: (0, 0), (1, 0), (0, 1), (1, 1). The fold is the line from the second to the third
  // corner.
  x[0] = {-half * std::cos(angle), 0, half * std::sin(angle)},
  x[3] = {half * std::cos(angle), 0, half * std::sin(angle)};
  x[1] = {0, -half, 0}, x[2] = {0, half, 0};
  x[4] = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  const CrossedMembrane without_shear(sheet, 0, stretch(0), {0, 0});
  EXPECT_NEAR(without_shear.energy(x), 0, 1e-15 * kStiffness);
  EXPECT_NEAR(crossed.max_strain(x), 0, 1e-12);
}

TEST(CrossedMembrane, IsThatOfItsTrianglesInParallelograms) {
  const mesh::Sheet sheet = crossed_sheet();
  const CrossedMembrane crossed(sheet, 0, stretch(2), shear(2));
  const TriangleMembrane plain(sheet, 0, stretch(2), shear(2));
  const Positions x = testing::moved_rigidly(parallelograms(sheet, 0.004));
  EXPECT_NEAR(crossed.energy(x), plain.energy(x), 1e-12 * plain.energy(x));
  EXPECT_NEAR(crossed.max_strain(x), plain.max_strain(x), 1e-12);
  const Positions a = testing::force_of(crossed, x, testing::zeros(x)),
                  b = testing::force_of(plain, x, testing::zeros(x));
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((a[i] - b[i]).norm(), 1e-11 * kStiffness * 0.02);
}

TEST(CrossedMembrane, ViscosityTakesEnergyAndNoneFromRigidMotion) {
  const mesh::Sheet sheet = crossed_sheet();
  const CrossedMembrane elastic(sheet, 0, stretch(0), shear(0)), viscous(sheet, 0, stretch(2), shear(2));
  const Positions x = crumpled(sheet, 0.006), rest = testing::force_of(elastic, x, testing::zeros(x));
  const auto power = [&](const Positions& v) {
    const Positions f = testing::force_of(viscous, x, v);
    double sum = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (f[i] - rest[i]).dot(v[i]), size = std::max(size, (f[i] - rest[i]).norm());
    return Vec2(sum, size);
  };
  EXPECT_LT(power(testing::random_vectors(x.size(), 1, 9)).x(), -1e-3);
  EXPECT_LT(power(testing::rigid_velocities(x)).y(), 1e-11);
}

TEST(CrossedMembrane, MatrixIsTheJacobianWhereNothingIsStressedAndNeverIndefinite) {
  const mesh::Sheet sheet = crossed_sheet();
  CrossedMembrane membrane(sheet, 0, stretch(0), shear(0));
  const Positions flat = sheet.rest, v = testing::zeros(flat);
  const Eigen::MatrixXd k = testing::stiffness_of(membrane, flat, v, 0);
  const Eigen::MatrixXd differences = testing::stiffness_by_differences(membrane, flat, v, 0, 1e-7);
  // Tolerance: a displacement causes stress, whose stiffness the matrix does not contain.
  EXPECT_LT((k - differences).cwiseAbs().maxCoeff(), 1e-4 * kStiffness);
  const Eigen::MatrixXd m = testing::stiffness_of(membrane, crumpled(sheet, 0.006), v, 0);
  EXPECT_LT((m - m.transpose()).norm(), 1e-12 * m.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues().minCoeff(), -1e-12 * m.norm());
}

}  // namespace
}  // namespace weft::forces
