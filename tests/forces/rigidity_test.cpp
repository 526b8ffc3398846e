// The stiffness of rigid bodies: force against energy, stiffness against force, and no force in rigid motions.
#include "physics/forces/rigidity.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "forces/sheets.hpp"
#include "physics/mesh/mesh.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::forces {
namespace {

constexpr double kMass = 2, kStiffness = 1e6;  // [kg], [1/s²]

/// A plate of 300 × 200 × 10 mm. The standard deviation of its mass along the shortest axis is a thirtieth of that
/// along the longest.
mesh::RigidFrame plate() {
  const mesh::Mesh mesh = mesh::make_box(Vec3(0.3, 0.2, 0.01), 0, 8);
  return {mesh.topology.triangles, mesh.positions};
}

using testing::Positions;

Positions moved(const mesh::RigidFrame& frame, const Mat3& by) {
  Positions x;
  for (const Vec3& particle : frame.particles()) x.emplace_back(by * particle + Vec3(1, -2, 3));
  return x;
}

Positions forces_at(const Rigidity& rigidity, const Positions& x) {
  return testing::force_of(rigidity, x, testing::zeros(x));
}

const Mat3 kTurn = Eigen::AngleAxisd(0.9, Vec3(2, -1, 2).normalized()).toRotationMatrix();

TEST(Rigidity, IsTheDescentOfItsEnergy) {
  const mesh::RigidFrame frame = plate();
  const Rigidity rigidity(frame, 0, kMass, kStiffness);
  Mat3 deform = kTurn;
  deform(0, 1) += 0.05, deform(2, 2) *= 1.1, deform(1, 0) -= 0.08;
  testing::expect_forces_from_energy(rigidity, moved(frame, deform), 1e-6, 1e-4);
}

TEST(Rigidity, LetsBodiesMoveAndTurn) {
  const mesh::RigidFrame frame = plate();
  const Rigidity rigidity(frame, 0, kMass, kStiffness);
  const Positions x = moved(frame, kTurn);
  EXPECT_LT(rigidity.energy(x), 1e-20 * kMass * kStiffness);
  for (const Vec3& force : forces_at(rigidity, x)) EXPECT_LT(force.norm(), 1e-12 * kMass * kStiffness);
}

TEST(Rigidity, HasNoResultantAndNoMoment) {
  const mesh::RigidFrame frame = plate();
  const Rigidity rigidity(frame, 0, kMass, kStiffness);
  Mat3 deform = kTurn;
  deform(0, 0) *= 1.2, deform(1, 2) += 0.1;
  const Positions x = moved(frame, deform), force = forces_at(rigidity, x);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    sum += force[k];
    moment += x[k].cross(force[k]);
    largest = std::max(largest, force[k].norm());
  }
  EXPECT_GT(largest, 1);
  EXPECT_LT(sum.norm(), 1e-12 * largest);
  EXPECT_LT(moment.norm(), 1e-11 * largest);
}

TEST(Rigidity, HasOneFrequencyForStretchesOfThinAndThick) {
  const mesh::RigidFrame frame = plate();
  const Rigidity rigidity(frame, 0, kMass, kStiffness);
  constexpr double kStrain = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    Mat3 stretch = Mat3::Identity();
    stretch(axis, axis) += kStrain;
    const Positions x = moved(frame, stretch), start = moved(frame, Mat3::Identity());
    double moved_sq = 0;  // mass-weighted mean square of the displacement [m²]
    for (std::size_t k = 0; k < 4; ++k) moved_sq += 0.25 * (x[k] - start[k]).squaredNorm();
    // The expected energy is ½ m kStiffness times the mean square of the displacement. Tolerance: the strain has a term
    // of order kStrain², which changes the energy by a fraction of order kStrain.
    EXPECT_NEAR(rigidity.energy(x) / (0.5 * kStiffness * kMass * moved_sq), 1, 2 * kStrain);
  }
}

TEST(Rigidity, TakesItsStrainFromTheEndOfAMidpointStep) {
  // The plate rotates by 0.4 rad during the step. Its particles move along straight lines, so the plate is smaller in
  // the middle of the step; at the end, it has its rest shape.
  const mesh::RigidFrame frame = plate();
  const Rigidity rigidity(frame, 0, kMass, kStiffness);
  const Positions from = moved(frame, Mat3::Identity()),
                  to = moved(frame, Eigen::AngleAxisd(0.4, Vec3::UnitZ()).toRotationMatrix());
  constexpr double kStepLength = 0.01;
  Positions middle(4), v(4);
  for (std::size_t k = 0; k < 4; ++k) {
    middle[k] = 0.5 * (from[k] + to[k]);
    v[k] = (to[k] - from[k]) / kStepLength;
  }
  for (const Vec3& force : testing::force_of(rigidity, middle, v, 2 / kStepLength))
    EXPECT_LT(force.norm(), 1e-12 * kMass * kStiffness);
  // With rate 0, the force follows from the strain of `middle`.
  EXPECT_GT(forces_at(rigidity, middle)[0].norm(), 1e-4 * kMass * kStiffness);
}

TEST(Rigidity, IsLinearisedAsItChanges) {
  const mesh::RigidFrame frame = plate();
  Rigidity rigidity(frame, 0, kMass, kStiffness);
  const Positions x = moved(frame, kTurn), still = testing::zeros(x);
  // Without strain, the matrix is the exact Jacobian.
  const Eigen::MatrixXd differences = testing::stiffness_by_differences(rigidity, x, still, 0, 1e-7);
  EXPECT_LT((testing::stiffness_of(rigidity, x, still, 0) - differences).cwiseAbs().maxCoeff(),
            1e-4 * kMass * kStiffness);
}

}  // namespace
}  // namespace weft::forces
