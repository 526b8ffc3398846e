// Tests of Sliding, which measures the error of friction on a diagonal block of the system, here a solid on a floor.
#include "physics/integrator/sliding.hpp"

#include <gtest/gtest.h>

namespace weft::integrator {
namespace {

/// Contact forces on the whole block [N]. `limit`: maximum friction. `fraction`: of all forces, that on the first
/// particle; more than 1 if the particles are those of the frame of a rigid body, whose surface is outside of the
/// frame.
struct Contacts {
  Vec3 push, friction;
  double limit;
  double fraction = 0.5;
};

/// A solid of two particles, which form one diagonal block, and between which the forces `whole` are divided.
class Block final : public System {
 public:
  explicit Block(const Contacts& whole) : whole_(whole) {}

  bool contact_forces(const StagePoint&, std::span<Vec3> pushes, std::span<Vec3> frictions,
                      std::span<double> normal_forces, std::span<double> limits) const override {
    for (std::size_t i = 0; i < 2; ++i) {
      const double fraction = i == 0 ? whole_.fraction : 1 - whole_.fraction;
      pushes[i] += fraction * whole_.push;
      frictions[i] += fraction * whole_.friction;
      normal_forces[i] += fraction * whole_.push.norm();
      limits[i] += fraction * whole_.limit;
    }
    return true;
  }
  std::span<const double> masses() const override { return masses_; }
  void constant_forces(std::span<Vec3>) const override {}
  void forces(const StagePoint&, std::span<Vec3>) override {}
  void linearise(const StagePoint&, int, std::span<Vec3>) override {}
  solver::LinearSystem& linear_system() override { return system_; }

 private:
  Contacts whole_;
  std::vector<double> masses_{0.5, 0.5};
  solver::LinearSystem system_;
};

/// Error of friction [N] for the residual `missing` [N] of the whole block.
double friction_error(const Contacts& contacts, const Vec3& missing) {
  const std::vector<Vec3> nothing(2, Vec3::Zero()), residual(2, 0.5 * missing);
  Sliding sliding;
  sliding.evaluate(Block(contacts), {nothing, nothing, nothing, 1, 1});
  return sliding.friction_error({0, 2}, residual);
}

// The normal force is 10 N, the friction limit 3 N (coefficient 0.3).
TEST(Sliding, FrictionOfABlockAtRestIsRight) {
  EXPECT_EQ(friction_error({{0, 0, 10}, {-2, 0, 0}, 3}, Vec3::Zero()), 0);
  // The residual hardly moves a block that sticks.
  EXPECT_EQ(friction_error({{0, 0, 10}, {-2, 0, 0}, 3}, {-0.5, 0, 0}), 0);
  EXPECT_EQ(friction_error({{0, 0, 10}, Vec3::Zero(), 0}, {1, 0, 0}), 0);  // the contact has no friction
}

TEST(Sliding, CountsTheResidualAlongFrictionAtItsLimit) {
  EXPECT_NEAR(friction_error({{0, 0, 10}, {-3, 0, 0}, 3}, {1, 0, 0}), 1, 1e-12);        // friction is too large
  EXPECT_NEAR(friction_error({{0, 0, 10}, {-2.9, 0, 0}, 3}, {0.1, 0, 0}), 0.1, 1e-12);  // the block should slide
  EXPECT_NEAR(friction_error({{0, 0, 10}, {-3, 0, 0}, 3}, {0, 5, 0}), 0, 1e-12);        // residual across the slip
}

TEST(Sliding, CountsFrictionDueToANormalForceInTheResidual) {
  // The floor pushes with 20 N, but the motion needs only 10 N. So the friction limit should be 3 N, which is 1.4 N
  // less than the friction. A box on one face has the fraction 0.5 + √3 / 2.
  for (const double fraction : {0.5, 1.37})
    EXPECT_NEAR(friction_error({{0, 0, 20}, {-4.4, 0, 0}, 6, fraction}, {0, 0, 10}), 1.4, 1e-12) << fraction;
}

TEST(Sliding, AWallAllowsSlidingButAPinHoldsItsBlock) {
  Mat3 along = Mat3::Identity();
  along(2, 2) = 0;
  const std::vector<solver::ParticleConstraint> wall{{1, along}}, pin{{1, Mat3::Zero()}};
  EXPECT_FALSE(is_held({0, 2}, wall));
  EXPECT_TRUE(is_held({0, 2}, pin));
  EXPECT_FALSE(is_held({2, 4}, pin));
}

}  // namespace
}  // namespace weft::integrator
