// Prescribed velocities of single particles (seed, Eq. 4), with stiction, sliding and release.
#include "collision/response/velocity_constraints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace weft::collision {
namespace {

constexpr double kGravity = 9.81;
constexpr double kStep = 0.01, kDMin = 0.001, kMass = 2e-4;

/// One particle in front of walls, moved by forces that the test names.
struct OneParticle {
  VelocityConstraints constraints{{kMass}};
  std::vector<Vec3> x_t0{Vec3::Zero()}, x_t1{Vec3::Zero()};

  OneParticle() { constraints.begin_step(kStep); }
  void wall(const Vec3& normal, double distance, const Vec3& motion = Vec3::Zero(), double friction = 0) {
    constraints.add(0, normal, distance, kDMin, motion, friction);
  }
  void prepare() { constraints.prepare(x_t0, x_t1); }
  /// After a solve that led to x_end with this force of the constraint.
  int revise(const Vec3& x_end, const Vec3& force) {
    const std::vector<Vec3> at{x_end};
    return constraints.revise(x_t0, at, [&](Index) { return force; });
  }
  bool held() const { return !constraints.prescribed().empty(); }
  const PrescribedParticle& prescribed() const { return constraints.prescribed()[0]; }
};

TEST(VelocityConstraints, LetWhatArrivesComeToTheLeastDistanceAndStopThere) {
  OneParticle particle;
  particle.wall(Vec3::UnitZ(), 0.004);
  particle.x_t1[0] = Vec3(0.002, 0, -0.01);
  particle.prepare();
  ASSERT_TRUE(particle.held());
  // Eq. (4) with γ = 1: v_n h = d_min − d.
  EXPECT_NEAR(particle.prescribed().x_end.z(), kDMin - 0.004, 1e-15);
  EXPECT_NEAR(particle.prescribed().v_end.z(), 0, 1e-15);
  const Mat3 along = Vec3(1, 1, 0).asDiagonal();
  EXPECT_LT((particle.prescribed().constraint.free - along).norm(), 1e-15);
}

TEST(VelocityConstraints, LeaveAloneWhatDoesNotComeTooClose) {
  OneParticle particle;
  particle.wall(Vec3::UnitZ(), 0.004);
  particle.x_t1[0] = Vec3(0.002, 0, -0.0029);
  particle.prepare();
  EXPECT_FALSE(particle.held());
}

TEST(VelocityConstraints, MakeGoodAMissingDistanceOverSeveralSteps) {
  double distance = 0.2 * kDMin;
  for (int step = 0; step < 20; ++step) {
    OneParticle particle;
    particle.wall(Vec3::UnitZ(), distance);
    particle.x_t1[0] = Vec3(0, 0, -0.001);
    particle.prepare();
    const double next = distance + particle.prescribed().x_end.z();
    EXPECT_GT(next, distance);
    EXPECT_LT(next, distance + 0.5 * (kDMin - distance));
    distance = next;
  }
  EXPECT_NEAR(distance, kDMin, 0.02 * kDMin);
}

TEST(VelocityConstraints, MoveWithTheObstacle) {
  const Vec3 motion(0.003, 0.001, 0.002);
  OneParticle particle;
  particle.wall(Vec3::UnitZ(), kDMin, motion);
  particle.prepare();
  ASSERT_TRUE(particle.held());
  EXPECT_NEAR(particle.prescribed().x_end.z(), motion.z(), 1e-15);
  EXPECT_NEAR(particle.prescribed().v_end.z(), motion.z() / kStep, 1e-13);
}

TEST(VelocityConstraints, HoldAParticleInACornerByAllItsWalls) {
  // Of a right-angled and of an acute valley; the second needs the walls together, not one after the other.
  for (double slope : {1.0, 3.0}) {
    const Vec3 left = Vec3(slope, 0, 1).normalized(), right = Vec3(-slope, 0, 1).normalized();
    OneParticle particle;
    particle.wall(left, kDMin);
    particle.wall(right, kDMin);
    particle.x_t1[0] = Vec3(0.001, 0.003, -0.01);
    particle.prepare();
    ASSERT_TRUE(particle.held());
    EXPECT_NEAR(left.dot(particle.prescribed().x_end), 0, 1e-12);
    EXPECT_NEAR(right.dot(particle.prescribed().x_end), 0, 1e-12);
    const Mat3 along = Vec3(0, 1, 0).asDiagonal();
    EXPECT_LT((particle.prescribed().constraint.free - along).norm(), 1e-12);
  }
}

TEST(VelocityConstraints, AreReleasedByTheSignOfTheResidual) {
  for (double sign : {1.0, -1.0}) {
    OneParticle particle;
    particle.wall(Vec3::UnitZ(), kDMin);
    particle.x_t1[0] = Vec3(0, 0, -0.001);
    particle.prepare();
    ASSERT_TRUE(particle.held());
    const int changed = particle.revise(Vec3::Zero(), sign * kMass * kGravity * Vec3::UnitZ());
    EXPECT_EQ(changed, sign > 0 ? 0 : 1);
    EXPECT_EQ(particle.held(), sign > 0);
  }
}

TEST(VelocityConstraints, SlidingThatStopsSticksUntilTheForceLeavesTheFrictionCone) {
  constexpr double kMu = 0.5;
  const double weight = kMass * kGravity;
  for (double tangential : {0.9, 1.6}) {  // of μ · weight
    OneParticle particle;
    const auto begin = [&] {
      particle.constraints.begin_step(kStep);
      particle.wall(Vec3::UnitZ(), kDMin, Vec3::Zero(), kMu);
      particle.x_t1[0] = Vec3(0, 0, -1e-4);
      particle.prepare();
    };
    // At rest for two steps: the first one finds the load.
    for (int step = 0; step < 2; ++step) {
      begin();
      particle.revise(Vec3::Zero(), weight * Vec3::UnitZ());
      particle.constraints.accept();
    }
    begin();
    EXPECT_EQ(particle.prescribed().constraint.free, Mat3::Zero());
    // What is beyond the cone slides from the next step on.
    EXPECT_EQ(particle.revise(Vec3::Zero(), weight * Vec3(kMu * tangential, 0, 1)), 0);
    particle.constraints.accept();
    begin();
    EXPECT_EQ(particle.prescribed().constraint.free.isZero(), tangential < 1);

    // Friction of what slides: μ · load against the slip.
    std::vector<Vec3> force{Vec3::Zero()};
    const std::vector<Vec3> slid{Vec3(-0.001, 0, 0)};
    particle.constraints.add_forces(slid, force);
    const Vec3 expected = tangential > 1 ? Vec3(kMu * weight, 0, 0) : Vec3(Vec3::Zero());
    EXPECT_LT((force[0] - expected).norm(), 1e-12 * weight);
  }
}

}  // namespace
}  // namespace weft::collision
