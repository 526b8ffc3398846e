// Prescribed velocities of single particles (seed, Eq. (4)), with stiction, sliding and release.
#include "physics/collision/response/velocity_constraints.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "core/archive.hpp"
#include "core/numerics.hpp"

namespace weft::collision {
namespace {

constexpr double kGravity = 9.81;                            // [m/s²]
constexpr double kStep = 0.01, kDMin = 0.001, kMass = 2e-4;  // [s], [m], [kg]

/// One particle in front of walls. Each test passes the constraint force on it to revise().
struct OneParticle {
  VelocityConstraints constraints{{kMass}};
  std::vector<Vec3> x_t0{Vec3::Zero()}, x_t1{Vec3::Zero()};

  OneParticle() { constraints.begin_step(kStep); }
  void wall(const Vec3& normal, double distance, const Vec3& motion = Vec3::Zero(), double friction = 0) {
    constraints.add(0, normal, distance, kDMin, motion, friction);
  }
  void prepare() { constraints.prepare(x_t0, x_t1); }
  /// Revises the constraints after a solve with the end x_end and the constraint force `force`.
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

// A plate rises through a floor. The wall of the plate is added before or after that of the floor.
TEST(VelocityConstraints, MoveWithTheStricterOfTwoParallelWalls) {
  const Vec3 motion(0.001, 0, 0.002);
  for (const bool plate_first : {false, true}) {
    OneParticle particle;
    if (plate_first) particle.wall(Vec3::UnitZ(), kDMin, motion);
    particle.wall(Vec3::UnitZ(), 2 * kDMin);
    if (!plate_first) particle.wall(Vec3::UnitZ(), kDMin, motion);
    particle.prepare();
    ASSERT_TRUE(particle.held());
    EXPECT_NEAR(particle.prescribed().x_end.z(), motion.z(), 1e-15);
    EXPECT_NEAR(particle.prescribed().v_end.z(), motion.z() / kStep, 1e-13) << plate_first;
  }
}

TEST(VelocityConstraints, HoldAParticleInACornerByAllItsWalls) {
  // A right-angled and an acute valley; in the acute one, both walls must act at once, not one after the other.
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
  for (double tangential : {0.9, 1.6}) {  // tangential force, relative to μ · weight
    OneParticle particle;
    const auto begin = [&] {
      particle.constraints.begin_step(kStep);
      particle.wall(Vec3::UnitZ(), kDMin, Vec3::Zero(), kMu);
      particle.x_t1[0] = Vec3(0, 0, -1e-4);
      particle.prepare();
    };
    // The particle rests for three steps: the first gives the normal force; after two slow steps, the particle sticks.
    for (int step = 0; step < 3; ++step) {
      begin();
      particle.revise(Vec3::Zero(), weight * Vec3::UnitZ());
      particle.constraints.accept();
    }
    begin();
    EXPECT_EQ(particle.prescribed().constraint.free, Mat3::Zero());
    // If the force is outside the friction cone, the particle slides from the next step on.
    EXPECT_EQ(particle.revise(Vec3::Zero(), weight * Vec3(kMu * tangential, 0, 1)), 0);
    particle.constraints.accept();
    begin();
    EXPECT_EQ(particle.prescribed().constraint.free.isZero(), tangential < 1);

    // If the particle slides, friction is μ times the normal force, against the slip.
    std::vector<Vec3> force{Vec3::Zero()};
    const std::vector<Vec3> slid{Vec3(-0.001, 0, 0)};
    particle.constraints.add_forces(slid, force);
    const Vec3 expected = tangential > 1 ? Vec3(kMu * weight, 0, 0) : Vec3(Vec3::Zero());
    EXPECT_LT((force[0] - expected).norm(), 1e-12 * weight);
  }
}

// The particle sticks after three steps of rest.
TEST(VelocityConstraints, ListNormalForceAndFrictionOfAStickingParticle) {
  constexpr double kMu = 0.5;
  const Vec3 force = kMass * kGravity * Vec3(0.4 * kMu, 0, 1);
  OneParticle particle;
  for (int step = 0; step < 4; ++step) {
    particle.constraints.begin_step(kStep);
    particle.wall(Vec3::UnitZ(), kDMin, Vec3::Zero(), kMu);
    particle.x_t1[0] = Vec3(0, 0, -1e-4);
    particle.prepare();
    particle.revise(Vec3::Zero(), force);
    particle.constraints.accept();
  }
  ASSERT_EQ(particle.prescribed().constraint.free, Mat3::Zero());
  std::vector<Vec3> push{Vec3::Zero()}, friction = push;
  std::vector<double> normal_force{0}, limit{0};
  particle.constraints.add_normal_and_friction_forces(particle.x_t0, push, friction, normal_force, limit);
  EXPECT_LT((push[0] - Vec3(0, 0, force.z())).norm(), 1e-12 * force.norm());
  EXPECT_LT((friction[0] - Vec3(force.x(), 0, 0)).norm(), 1e-12 * force.norm());
  EXPECT_NEAR(normal_force[0], force.z(), 1e-12 * force.norm());
  EXPECT_NEAR(limit[0], kMu * force.z(), 1e-12 * force.norm());
}

TEST(VelocityConstraints, AParticleBetweenTwoWallsSticksHoweverManyOtherWallsItHas) {
  constexpr double kMu = 0.5;
  OneParticle particle;
  const auto begin = [&] {
    particle.constraints.begin_step(kStep);
    particle.wall(Vec3(1, 0, 1).normalized(), kDMin, Vec3::Zero(), kMu);
    particle.wall(Vec3(-1, 0, 1).normalized(), kDMin, Vec3::Zero(), kMu);
    for (int k = 0; k < numerics.walls.max_walls; ++k)
      particle.wall(Vec3(std::cos(k), std::sin(k), 2).normalized(), 100 * kDMin, Vec3::Zero(), kMu);
    particle.x_t1[0] = Vec3(0.001, 0, -0.01);  // passes the second wall by more than the first
    particle.prepare();
  };
  // The force presses more against the first wall, so the order of both walls differs between the projections of the
  // displacement and of the force.
  for (int step = 0; step < 3; ++step) {
    begin();
    particle.revise(Vec3::Zero(), kMass * kGravity * Vec3(0.3, 0, 1));
    particle.constraints.accept();
  }
  begin();
  EXPECT_EQ(particle.prescribed().constraint.free, Mat3::Zero());
}

TEST(VelocityConstraints, ForgetWhatTheyHeldIfAnEarlierStateIsRestored) {
  OneParticle particle;
  ByteWriter start;
  particle.constraints.serialize(start);
  const auto begin = [&] {
    particle.constraints.begin_step(kStep);
    particle.wall(Vec3::UnitZ(), kDMin, Vec3::Zero(), 0.5);
    particle.x_t1[0] = Vec3(0, 0, -1e-4);
    particle.prepare();
  };
  for (int step = 0; step < 3; ++step) {
    begin();
    particle.revise(Vec3::Zero(), kMass * kGravity * Vec3::UnitZ());
    particle.constraints.accept();
  }
  begin();
  EXPECT_EQ(particle.prescribed().constraint.free, Mat3::Zero()) << "it sticks";
  ByteReader bytes{start.bytes};
  particle.constraints.serialize(bytes);
  begin();
  EXPECT_NE(particle.prescribed().constraint.free, Mat3::Zero()) << "it slides, as in a first step";
}

TEST(VelocityConstraints, PredictContactsWithMissingWallsThatHeldInTheLastStep) {
  OneParticle particle;
  std::vector<Vec3> leaning;
  particle.wall(Vec3::UnitZ(), kDMin);
  particle.x_t1[0] = Vec3(0, 0, -1e-4);
  EXPECT_FALSE(particle.constraints.predict_wall_contacts(particle.x_t1, 0.001, leaning));
  particle.prepare();
  particle.revise(Vec3::Zero(), kMass * kGravity * Vec3::UnitZ());
  particle.constraints.accept();
  particle.constraints.begin_step(kStep);
  EXPECT_TRUE(particle.constraints.predict_wall_contacts(particle.x_t1, 0.001, leaning));
  EXPECT_LT((leaning[0] - Vec3(0, 0, -1.1e-3)).norm(), 1e-18);
  particle.wall(Vec3::UnitZ(), kDMin);
  EXPECT_FALSE(particle.constraints.predict_wall_contacts(particle.x_t1, 0.001, leaning));
}

// Slips above and below the stick slip of 2e-6 m, with a moving obstacle.
TEST(VelocityConstraints, JacobianOfSlidingIsExactWhereItGoesOnAndNeverTooSoftWhereItBegins) {
  constexpr double kMu = 0.5, kDelta = 1e-10;
  const double weight = kMass * kGravity;
  const Vec3 motion(1e-4, 0, 0);
  for (const bool goes_on : {true, false})
    for (const Vec3& slip : {Vec3(-0.001, 0.0004, 0), Vec3(3e-7, 4e-7, 0)}) {
      OneParticle particle;
      // The particle rests for three steps, then is pulled beyond the friction cone, then slides.
      for (int step = 0; step < 5; ++step) {
        particle.constraints.begin_step(kStep);
        particle.wall(Vec3::UnitZ(), kDMin, motion, kMu);
        particle.x_t1[0] = motion + Vec3(0, 0, -1e-4);
        if (step == 4 && goes_on) particle.x_t1[0] += slip;
        particle.prepare();
        if (step == 4) break;
        particle.revise(motion, weight * Vec3(step == 3 ? 2 * kMu : 0, 0, 1));
        particle.constraints.accept();
      }
      const auto force_at = [&](const Vec3& slid) {
        std::vector<Vec3> force{Vec3::Zero()};
        particle.constraints.add_forces(std::vector<Vec3>{motion + slid}, force);
        return force[0];
      };
      ASSERT_NEAR(force_at(slip).norm(), weight * kMu * (slip.norm() < 1e-6 ? 0.4375 : 1), 1e-9 * weight);
      std::vector<Vec3> force{Vec3::Zero()};
      solver::LinearSystem system;
      particle.constraints.linearise(std::vector<Vec3>{motion + slip}, 2, force, system);
      ASSERT_EQ(system.diagonal_terms.size(), 1U);
      EXPECT_EQ(force[0], force_at(slip));
      Mat3 exact;
      for (int k = 0; k < 3; ++k)
        exact.col(k) = (force_at(slip - kDelta * Vec3::Unit(k)) - force_at(slip + kDelta * Vec3::Unit(k))) / kDelta;
      const Mat3 got = system.diagonal_terms[0].stiffness;
      // Tolerance, relative to `size` [N/m]: rounding errors of the force, about 1e-16 of it, over 1e-10 m, and the
      // error of central differences.
      const double size = 2 * weight * kMu / slip.norm();
      if (goes_on)
        EXPECT_LT((got - exact).norm(), 1e-4 * size);
      else
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(got - exact).eigenvalues().minCoeff(), -1e-4 * size);
    }
}

}  // namespace
}  // namespace weft::collision
