// Tests of friction_tangent() and of its use in the linear system.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "physics/collision/response/contact_set.hpp"

namespace weft::collision {
namespace {

// If an iterate exceeds the friction cone, the friction must not make the matrix indefinite.
TEST(FrictionTangent, IsNeverNegativeHoweverLargeTheFriction) {
  const Vec3 n = Vec3(1, 2, 3).normalized(), along = n.unitOrthogonal(), beside = n.cross(along);
  const Mat3 across = Mat3::Identity() - n * n.transpose();
  for (const double size : {0.5, 1.0, 3.0, 100.0})
    for (double angle = 0; angle < 6; angle += 0.5) {
      const Vec3 w = size * (std::cos(angle) * along + std::sin(angle) * beside);
      const Mat3 tangent = friction_tangent(across, 0.7 * along, w);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(tangent).eigenvalues().minCoeff(), -1e-12) << size << ", " << angle;
    }
}

// A particle slides on a plane. The coefficient of static friction is positive, that of sliding friction is 0.
TEST(FrictionTangent, IsZeroIfSlidingHasNoFriction) {
  Contact contact;
  contact.weights = {1, 0, 0, 0};
  contact.against_obstacle = true;
  contact.range = contact.full_range = 0.002;
  contact.depth = 0.001;
  contact.stiffness = 500;
  contact.static_friction = 0.3;
  ContactSet contacts;
  contacts.set_step(0.01);
  contacts.add(contact);
  const std::vector<Vec3> x{Vec3(0.01, 0, 0.001)};
  std::vector<Vec3> force{Vec3::Zero()};
  ContactStates lag;
  contacts.update(x, lag);
  solver::LinearSystem system;
  system.matrix = solver::BlockMatrix(1, {});
  contacts.linearise(x, 1, lag, force, system);
  ASSERT_EQ(system.diagonal_terms.size(), 1U);
  Mat3 friction = system.diagonal_terms[0].stiffness;
  EXPECT_GT(friction(2, 2), 0) << "of the spring";
  friction(2, 2) = 0;
  EXPECT_TRUE(friction.isZero(0));
  EXPECT_EQ(force[0].x(), 0);
}

}  // namespace
}  // namespace weft::collision
