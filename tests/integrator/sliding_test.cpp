// Friction that a part of the system as a whole cannot have, against what a block on a floor says.
#include "integrator/sliding.hpp"

#include <gtest/gtest.h>

namespace weft::integrator {
namespace {

struct Contacts {
  Vec3 push, friction;
  double limit;
};

/// A block of two particles on a floor, each with half of these forces.
class Block final : public System {
 public:
  explicit Block(const Contacts& whole) : whole_(whole) {}

  bool contact_forces(const StagePoint&, std::span<Vec3> pushes, std::span<Vec3> frictions,
                      std::span<double> limits) const override {
    for (std::size_t i = 0; i < 2; ++i) {
      pushes[i] += 0.5 * whole_.push;
      frictions[i] += 0.5 * whole_.friction;
      limits[i] += 0.5 * whole_.limit;
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

/// By a residual that is missing as a whole.
double wrong_friction(const Contacts& contacts, const Vec3& missing) {
  const std::vector<Vec3> nothing(2, Vec3::Zero()), residual(2, 0.5 * missing);
  Sliding sliding;
  sliding.evaluate(Block(contacts), {nothing, nothing, nothing, 1, 1});
  return sliding.wrong_friction({0, 2}, residual);
}

// Friction 0.3 of 10 N.
TEST(Sliding, FrictionOfABlockAtRestIsRight) {
  EXPECT_EQ(wrong_friction({{0, 0, 10}, {-2, 0, 0}, 3}, Vec3::Zero()), 0);
  // However much is left: what sticks hardly moves by it.
  EXPECT_EQ(wrong_friction({{0, 0, 10}, {-2, 0, 0}, 3}, {-0.5, 0, 0}), 0);
  EXPECT_EQ(wrong_friction({{0, 0, 10}, Vec3::Zero(), 0}, {1, 0, 0}), 0);
}

TEST(Sliding, MomentumThatIsMissingAlongFrictionAtItsLimitCounts) {
  EXPECT_NEAR(wrong_friction({{0, 0, 10}, {-3, 0, 0}, 3}, {1, 0, 0}), 1, 1e-12);        // held back too much
  EXPECT_NEAR(wrong_friction({{0, 0, 10}, {-2.9, 0, 0}, 3}, {0.1, 0, 0}), 0.1, 1e-12);  // it should have slid
  EXPECT_NEAR(wrong_friction({{0, 0, 10}, {-3, 0, 0}, 3}, {0, 5, 0}), 0, 1e-12);        // across
}

TEST(Sliding, FrictionByALoadThatIsMissingItselfCounts) {
  // The floor pushes with 20 N where the motion takes 10, so 3 N of friction are what it can have.
  EXPECT_NEAR(wrong_friction({{0, 0, 20}, {-4.4, 0, 0}, 6}, {0, 0, 10}), 1.4, 1e-12);
}

TEST(Sliding, AWallThatIsSlidAlongHoldsNothing) {
  Mat3 along = Mat3::Identity();
  along(2, 2) = 0;
  const std::vector<solver::ParticleConstraint> wall{{1, along}}, pin{{1, Mat3::Zero()}};
  EXPECT_FALSE(is_held({0, 2}, wall));
  EXPECT_TRUE(is_held({0, 2}, pin));
  EXPECT_FALSE(is_held({2, 4}, pin));
}

}  // namespace
}  // namespace weft::integrator
