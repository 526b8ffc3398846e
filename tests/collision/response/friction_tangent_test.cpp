// The tangent of friction that the linear system contains.
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

}  // namespace
}  // namespace weft::collision
