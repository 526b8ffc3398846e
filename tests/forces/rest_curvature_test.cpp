// Triangle cloth with a curved rest shape.
#include <gtest/gtest.h>

#include <cmath>

#include "forces/sheets.hpp"
#include "forces/triangle_meshes.hpp"

namespace weft::forces {
namespace {

using testing::kRigidity;
using testing::Positions;

/// Positions of a flat mesh that is rolled about the warp without stretch. Positive curvature [1/m] bends it toward its
/// front, +z.
Positions rolled(const mesh::Mesh& flat, double curvature) {
  Positions x;
  for (const Vec2& uv : flat.uv) {
    const double angle = curvature * uv.x();
    x.emplace_back(curvature == 0 ? uv.x() : std::sin(angle) / curvature, uv.y(),
                   curvature == 0 ? 0 : (1 - std::cos(angle)) / curvature);
  }
  return x;
}

mesh::Mesh strip(int cells) {
  return testing::delaunay_sheet(testing::grid_of_squares({0.3, 0.1}, cells), 0.3, 5);
}

mesh::Sheet rest_of(mesh::Mesh mesh, double curvature) {
  mesh.positions = rolled(mesh, curvature);
  return mesh::make_sheet_from_mesh(mesh);
}

TEST(RestCurvature, RestShapeHasNeitherForceNorEnergyWhicheverWayItBends) {
  for (double curvature : {5.0, -5.0}) {
    const mesh::Sheet sheet = rest_of(strip(6), curvature);
    const TriangleBend bend(sheet, 0, {kRigidity, 1e-5, 1e-4});
    for (const Positions& x : {sheet.rest, testing::moved_rigidly(sheet.rest)}) {
      // Tolerance: coordinates have rounding errors of 4e-16 m, which the force multiplies by B / l² = 1 N/m; the
      // weights of the stencils add errors of the same size.
      EXPECT_LT(testing::largest(testing::force_of(bend, x, testing::zeros(x))), 1e-13);
      EXPECT_LT(bend.energy(x), 1e-20);
    }
  }
}

TEST(RestCurvature, EnergyIsThatOfTheChangeOfCurvatureWithItsSign) {
  // The expected energy is ½ B (κ − κ0)² A with signed curvatures: rolling the sheet to the other side changes the
  // curvature twice as much as flattening it. The error is of first order in the spacing, because half a cell at either
  // free end has no moment.
  for (double rest : {4.0, -4.0})
    for (double now : {0.0, 2.0, -4.0, 6.0}) {
      const auto error_at = [&](int cells) {
        const mesh::Mesh mesh = strip(cells);
        const TriangleBend bend(rest_of(mesh, rest), 0, {kRigidity, 0});
        return bend.energy(rolled(mesh, now)) / (0.5 * kRigidity * (now - rest) * (now - rest) * 0.03) - 1;
      };
      if (now == rest) continue;
      EXPECT_LT(std::abs(error_at(20)), 0.025) << rest << " to " << now;
      EXPECT_LT(std::abs(error_at(20)), 0.65 * std::abs(error_at(10))) << rest << " to " << now;
    }
}

TEST(RestCurvature, FlattenedStripPullsBackWithTheAnalyticMoment) {
  // E = ½ B (κ − κ0)² A, so the forces on the flat strip (κ = 0) do the work −dE/dκ = B κ0 A per change of curvature.
  const mesh::Mesh mesh = strip(20);
  for (double rest : {4.0, -4.0}) {
    const TriangleBend bend(rest_of(mesh, rest), 0, {kRigidity, 0});
    constexpr double kStep = 1e-4;
    const Positions after = rolled(mesh, kStep), before = rolled(mesh, -kStep);
    const Positions f = testing::force_of(bend, rolled(mesh, 0), testing::zeros(mesh.positions));
    double work = 0;
    for (std::size_t i = 0; i < f.size(); ++i) work += f[i].dot(after[i] - before[i]) / (2 * kStep);
    const double expected = kRigidity * rest * 0.03;
    EXPECT_NEAR(work, expected, 0.025 * std::abs(expected));
  }
}

TEST(RestCurvature, ForceAndJacobianAreDerivatives) {
  const mesh::Mesh mesh = testing::delaunay_sheet(testing::kGrid, 0.3, 3);
  for (double curvature : {8.0, -8.0})
    for (unsigned seed = 1; seed <= 2; ++seed) {
      TriangleBend bend(rest_of(mesh, curvature), 0, {1, 0});
      const Positions x = testing::shaken(rolled(mesh, 0.5 * curvature), 0.003, seed), still = testing::zeros(x);
      constexpr double kEpsilon = 4e-7;
      testing::expect_forces_from_energy(bend, x, kEpsilon, 5e-8);
      const Eigen::MatrixXd exact = testing::jacobian_of(bend, x, still, 0);
      const Eigen::MatrixXd differences = testing::stiffness_by_differences(bend, x, still, 0, kEpsilon);
      EXPECT_LT((exact - differences).cwiseAbs().maxCoeff(), 5e-8 * exact.cwiseAbs().maxCoeff());
    }
}

TEST(RestCurvature, DefiniteJacobianIsPositiveSemidefiniteAndExactAtRest) {
  const mesh::Sheet sheet = rest_of(testing::delaunay_sheet(testing::kGrid, 0.3, 3), 8);
  TriangleBend bend(sheet, 0, {1, 0});
  const Positions still = testing::zeros(sheet.rest);
  for (unsigned seed = 0; seed <= 4; ++seed) {
    const Positions x = testing::shaken(sheet.rest, seed == 0 ? 0 : 0.006, seed);
    const Eigen::MatrixXd k = testing::stiffness_of(bend, x, still, 0);
    const double scale = k.cwiseAbs().maxCoeff();
    EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
    EXPECT_GT(k.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-13 * scale);
    if (seed == 0) {
      const Eigen::MatrixXd exact = testing::jacobian_of(bend, x, still, 0);
      EXPECT_LT((k - exact).cwiseAbs().maxCoeff(), 1e-11 * scale);
    }
  }
}

TEST(RestCurvature, NoForceSumsUpOrTurns) {
  const mesh::Sheet sheet = rest_of(testing::delaunay_sheet(testing::kGrid, 0.3, 3), -8);
  const TriangleBend bend(sheet, 0, {1, 1e-3, 1e-2});
  const Positions x = testing::shaken(sheet.rest, 0.004, 1);
  const Positions f = testing::force_of(bend, x, testing::random_vectors(x.size(), 1, 2));
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) sum += f[i], torque += x[i].cross(f[i]);
  EXPECT_LT(sum.norm(), 1e-12 * testing::largest(f));
  EXPECT_LT(torque.norm(), 1e-13 * testing::largest(f));
}

}  // namespace
}  // namespace weft::forces
