// Tests of ContactSet: contact springs, friction, and their linearisation.
#include "physics/collision/response/contact_set.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace weft::collision {
namespace {

constexpr double kSlidingStep = 0.02;  // [s]
constexpr double kRange = 0.002;       // activation distance [m]

std::mt19937& engine() {
  static std::mt19937 generator;
  return generator;
}
Vec3 random_vector(double size) {
  std::uniform_real_distribution<double> number(-size, size);
  const double x = number(engine()), y = number(engine()), z = number(engine());
  return {x, y, z};
}

/// Normal force [N] of a contact with a stiffness of 500 N/m; slope_at() is its derivative [N/m]. `depth`: relative to
/// kRange, at most 1.
double normal_force_at(double depth) {
  return 500 * kRange * depth * (1 + numerics.contact.stiffening * std::pow(depth, 4));
}
double slope_at(double depth) {
  return 500 * (1 + 5 * numerics.contact.stiffening * std::pow(depth, 4));
}

/// Vertex 0 is 0.4 kRange above the inside of the triangle of vertices 1 to 3, along a slanted normal.
struct VertexOnFace {
  std::vector<Vec3> x;
  Contact contact;

  explicit VertexOnFace(double friction) {
    engine().seed(1);
    const Vec3 n = Vec3(1, -2, 4).normalized();
    const Vec3 along = n.unitOrthogonal(), across = n.cross(along);
    contact.particles = {0, 1, 2, 3};
    contact.weights = {1, -0.2, -0.5, -0.3};
    contact.normal = n;
    contact.range = kRange;
    contact.stiffness = 500;
    contact.friction = friction;
    x = {Vec3::Zero(), 0.02 * along, 0.02 * across, -0.02 * along - 0.01 * across};
    x[0] = 0.2 * x[1] + 0.5 * x[2] + 0.3 * x[3] + 0.4 * kRange * n;
    contact.relative_start = 0.4 * kRange * n;
    contact.depth = 0.6 * kRange;
  }

  ContactSet set() const {
    ContactSet contacts;
    contacts.set_step(kSlidingStep);
    contacts.add(contact);
    return contacts;
  }
  double gap(const std::vector<Vec3>& at) const { return contact.normal.dot(relative(at)); }
  Vec3 relative(const std::vector<Vec3>& at) const { return at[0] - 0.2 * at[1] - 0.5 * at[2] - 0.3 * at[3]; }
  double energy(const std::vector<Vec3>& at) const {
    return contact.stiffness * kRange * kRange * energy_at((kRange - gap(at)) / kRange);
  }
  /// Energy divided by stiffness · kRange²: the integral of d (1 + c d⁴) up to `depth`, which is relative to kRange. At
  /// depths beyond 1, the force is linear.
  static double energy_at(double depth) {
    const double c = numerics.contact.stiffening;
    if (depth <= 0) return 0;
    const double inner = std::min(depth, 1.0), beyond = depth - inner;
    return 0.5 * inner * inner + c / 6 * std::pow(inner, 6) + (1 + c) * beyond + 0.5 * (1 + 5 * c) * beyond * beyond;
  }
  std::vector<Vec3> jittered(double size) const {
    std::vector<Vec3> at = x;
    for (Vec3& point : at) point += random_vector(size);
    return at;
  }
};

/// States of the contacts before the first linearisation of a step, at x [m].
ContactStates states_at_start(const ContactSet& contacts, const std::vector<Vec3>& x) {
  ContactStates states;
  contacts.update(x, states);
  return states;
}

std::vector<Vec3> forces_of(const ContactSet& contacts, const std::vector<Vec3>& x, const ContactStates& states) {
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  contacts.add_forces(ForceLaw::exact, x, states, f);
  return f;
}
std::vector<Vec3> forces_of(const ContactSet& contacts, const std::vector<Vec3>& x) {
  return forces_of(contacts, x, states_at_start(contacts, x));
}

TEST(ContactSet, ForceWithoutFrictionIsMinusTheGradientOfTheEnergy) {
  const VertexOnFace pair(0);
  const ContactSet contacts = pair.set();
  constexpr double kEpsilon = 1e-7;
  int pushing = 0;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3> x = pair.jittered(0.002);
    const auto f = forces_of(contacts, x);
    pushing += contacts.count_active(x);
    for (std::size_t i = 0; i < 4; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const double place = x[i][axis];
        x[i][axis] = place + kEpsilon;
        const double above = pair.energy(x);
        x[i][axis] = place - kEpsilon;
        const double below = pair.energy(x);
        x[i][axis] = place;
        // Tolerance: ε²/6 times the third derivative of the energy, 20 c k d³/r⁴ (c = 100, d ≤ r), is at most 8e-7 N.
        EXPECT_NEAR(f[i][axis], -(above - below) / (2 * kEpsilon), 1e-6);
      }
  }
  // Some trials are within the activation distance, others are outside.
  EXPECT_GT(pushing, 5);
  EXPECT_LT(pushing, 20);
}

TEST(ContactSet, ForceIsContinuousAtTheRangeAndNoneBeyond) {
  const VertexOnFace pair(0.5);
  const ContactSet contacts = pair.set();
  for (double offset : {-1e-9, 0.0, 1e-9, 1e-3}) {
    std::vector<Vec3> x = pair.x;
    x[0] += (0.6 * kRange + offset) * pair.contact.normal;
    const double force = forces_of(contacts, x)[0].norm();
    // Tolerance: rounding of coordinates by 1e-17 m, at 500 N/m, changes the force by about 5e-15 N.
    EXPECT_NEAR(force, 500 * std::max(0.0, -offset), 1e-13) << offset;
    EXPECT_EQ(contacts.count_active(x), offset < 0 ? 1 : 0);
  }
}

TEST(ContactSet, ForcesSumToZero) {
  const VertexOnFace pair(0.5);
  const ContactSet contacts = pair.set();
  for (int trial = 0; trial < 10; ++trial) {
    const auto f = forces_of(contacts, pair.jittered(0.0005));
    EXPECT_LT((f[0] + f[1] + f[2] + f[3]).norm(), 1e-14);
  }
}

TEST(ContactSet, FrictionOpposesTheSlipAndIsBoundedByTheLoad) {
  const double mu = 0.4;
  const VertexOnFace pair(mu), smooth(0);
  const ContactSet contacts = pair.set(), frictionless = smooth.set();
  const Vec3 n = pair.contact.normal;
  // Before the first solve, friction uses the normal force at the initial depth, 0.6 kRange.
  const double normal_force = normal_force_at(0.6);
  const double stick = numerics.contact.stick_velocity * kSlidingStep;
  const Vec3 direction = n.unitOrthogonal();
  double last = 0;
  for (double fraction : {0.0, 0.1, 0.5, 0.9, 1.0, 1.1, 10.0, 1000.0}) {
    std::vector<Vec3> x = pair.x;
    x[0] += fraction * stick * direction;
    const Vec3 friction = forces_of(contacts, x)[0] - forces_of(frictionless, x)[0];
    EXPECT_LT((friction + friction.norm() * direction).norm(), 1e-12 * mu * normal_force) << fraction;
    EXPECT_LE(friction.norm(), mu * normal_force * (1 + 1e-12));
    EXPECT_GE(friction.norm(), last * (1 - 1e-12));  // friction grows with the slip
    last = friction.norm();
    const double expected = fraction < 1 ? mu * normal_force * fraction * (2 - fraction) : mu * normal_force;
    EXPECT_NEAR(friction.norm(), expected, 1e-9 * mu * normal_force);
  }
}

TEST(ContactSet, StaticFrictionHoldsMoreThanThatOfSliding) {
  VertexOnFace pair(0.4), smooth(0);
  pair.contact.static_friction = 0.7;
  const ContactSet contacts = pair.set(), frictionless = smooth.set();
  const double normal_force = normal_force_at(0.6);
  const double stick = numerics.contact.stick_velocity * kSlidingStep;
  const auto coefficient = [&](double slip) {
    std::vector<Vec3> x = pair.x;
    x[0] += slip * stick * pair.contact.normal.unitOrthogonal();
    return (forces_of(contacts, x)[0] - forces_of(frictionless, x)[0]).norm() / normal_force;
  };
  EXPECT_NEAR(coefficient(1), 0.7, 1e-9);
  EXPECT_NEAR(coefficient(0.5 * (1 + numerics.contact.slide_velocity)), 0.55, 1e-9);
  EXPECT_NEAR(coefficient(numerics.contact.slide_velocity), 0.4, 1e-9);
  EXPECT_NEAR(coefficient(1000), 0.4, 1e-9);
}

TEST(ContactSet, MotionAlongTheNormalIsNoSlip) {
  const VertexOnFace pair(0.4), smooth(0);
  std::vector<Vec3> x = pair.x;
  x[0] += 0.3 * kRange * pair.contact.normal;
  const Vec3 friction = forces_of(pair.set(), x)[0] - forces_of(smooth.set(), x)[0];
  EXPECT_LT(friction.norm(), 1e-12);
}

TEST(ContactSet, FrictionFollowsTheNormalForceOfTheLastUpdateAndFinallyKeepsIt) {
  const double mu = 0.4;
  const VertexOnFace pair(mu);
  const ContactSet contacts = pair.set();
  ContactStates states;
  std::vector<Vec3> x = pair.x;
  x[0] += 0.4 * kRange * pair.contact.normal + 0.01 * pair.contact.normal.unitOrthogonal();  // depth 0.2 kRange
  const auto tangential = [&] {
    std::vector<Vec3> forces(x.size(), Vec3::Zero());
    contacts.add_forces(ForceLaw::tangent, x, states, forces);
    const Vec3 f = forces[0];
    return (f - pair.contact.normal.dot(f) * pair.contact.normal).norm();
  };
  contacts.update(x, states);
  EXPECT_NEAR(tangential(), mu * normal_force_at(0.6), 1e-12);
  // add_forces() uses the present normal force until updates stop, so that the residual contains the error of the
  // constant normal force in the linear system.
  const Vec3 itself = forces_of(contacts, x, states)[0];
  EXPECT_NEAR(itself.dot(pair.contact.normal.unitOrthogonal()), -mu * normal_force_at(0.2), 1e-12);
  contacts.update(x, states);
  // The normal force is linearised at the initial depth, 0.6 kRange, and friction uses the linearised force.
  const auto tangent = [](double at, double depth) {
    return std::max(0.0, normal_force_at(at) + slope_at(at) * kRange * (depth - at));
  };
  EXPECT_NEAR(tangential(), mu * tangent(0.6, 0.2), 1e-12);
  for (int k = 2; k < numerics.newton.slow_after - 1; ++k) contacts.update(x, states);
  EXPECT_NEAR(tangential(), mu * normal_force_at(0.2),
              1e-3 * mu * normal_force_at(0.2));  // error that these updates leave
  // After a limited number of updates in a step, the normal force stays constant, so that iterations end.
  contacts.update(x, states);
  const double last = tangential();
  x[0] -= 0.2 * kRange * pair.contact.normal;
  contacts.update(x, states);
  EXPECT_NEAR(tangential(), last, 1e-12);
  states = {};
  contacts.update(x, states);
  contacts.update(x, states);
  EXPECT_NEAR(tangential(), mu * tangent(0.6, 0.4), 1e-12);
}

TEST(ContactSet, FrictionOfAContactThatIsNewInAStepBeginsWithTheLoadOfItsStart) {
  const VertexOnFace pair(0.4);
  ContactSet contacts = pair.set();
  ContactStates states;
  states.updates = numerics.newton.slow_after;
  contacts.update(pair.x, states);
  states.normal_forces[0] = 7;
  contacts.add(pair.contact);
  contacts.update(pair.jittered(0.0003), states);
  EXPECT_EQ(states.normal_forces[0], 7);
  EXPECT_NEAR(states.normal_forces[1], normal_force_at(0.6), 1e-12);
}

// −∂f/∂x of all contacts [N/m], from the terms that linearise() adds to the system.
Eigen::MatrixXd assembled(const solver::LinearSystem& system) {
  const Index rows = system.matrix.rows();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
  for (Index i = 0; i < rows; ++i) k.block<3, 3>(3 * i, 3 * i) = system.matrix.block(system.matrix.diagonal(i));
  for (const solver::DiagonalTerm& term : system.diagonal_terms)
    k.block<3, 3>(3 * term.particle, 3 * term.particle) += term.stiffness;
  for (const solver::StencilTerm& term : system.terms)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        k.block<3, 3>(3 * term.particles[a], 3 * term.particles[b]) +=
            term.weights[a] * term.weights[b] * term.stiffness;
  return k;
}

// Contact forces in the linear system [N], linearised at the initial depths.
std::vector<Vec3> linear_forces_of(const ContactSet& contacts, const std::vector<Vec3>& x) {
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  contacts.add_forces(ForceLaw::tangent, x, states_at_start(contacts, x), f);
  return f;
}

// −∂f/∂x [N/m] times `rate`, by central differences of linear_forces_of().
Eigen::MatrixXd differences(const ContactSet& contacts, std::vector<Vec3> x, double rate) {
  constexpr double kEpsilon = 1e-10;
  const auto size = static_cast<Eigen::Index>(3 * x.size());
  Eigen::MatrixXd k(size, size);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double place = x[i][axis];
      x[i][axis] = place + kEpsilon;
      const auto above = linear_forces_of(contacts, x);
      x[i][axis] = place - kEpsilon;
      const auto below = linear_forces_of(contacts, x);
      x[i][axis] = place;
      for (std::size_t r = 0; r < x.size(); ++r)
        k.block<3, 1>(static_cast<Eigen::Index>(3 * r), static_cast<Eigen::Index>(3 * i) + axis) =
            rate * (below[r] - above[r]) / (2 * kEpsilon);
    }
  return k;
}

solver::LinearSystem linearised(const ContactSet& contacts, const std::vector<Vec3>& x, double rate) {
  solver::LinearSystem system;
  system.matrix = solver::BlockMatrix(static_cast<Index>(x.size()), {});
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  contacts.linearise(x, rate, states_at_start(contacts, x), f, system);
  EXPECT_EQ(f, linear_forces_of(contacts, x));
  return system;
}

TEST(ContactSet, JacobianIsThatOfCentralDifferencesAtFixedLoad) {
  for (double rate : {1.0, 2.0}) {
    // The frictionless contact is tested at a random depth; the contact with friction, at zero slip.
    const VertexOnFace smooth(0), rough(0.4);
    std::vector<Vec3> x = smooth.jittered(0.0003);
    ASSERT_EQ(smooth.set().count_active(x), 1);
    const Eigen::MatrixXd spring = assembled(linearised(smooth.set(), x, rate));
    // Tolerance: coordinates are rounded by 1e-17 m, and displaced by 1e-10 m; this gives a relative error of 1e-7.
    EXPECT_LT((spring - differences(smooth.set(), x, rate)).cwiseAbs().maxCoeff(), 1e-5 * spring.maxCoeff());
    const Eigen::MatrixXd sticking = assembled(linearised(rough.set(), rough.x, rate));
    // Tolerance: the secant of friction, 2/ε − s/ε² (slip s, stick slip ε), changes by 3e-5 of itself over 1e-10 m.
    EXPECT_LT((sticking - differences(rough.set(), rough.x, rate)).cwiseAbs().maxCoeff(), 1e-4 * sticking.maxCoeff());
    EXPECT_GT(sticking.maxCoeff(), 2 * spring.maxCoeff());
  }
}

/// A vertex that slips on a face. Slips are relative to the stick slip ε.
struct Slipping : VertexOnFace {
  ContactSet contacts;
  ContactStates states;
  Vec3 along = contact.normal.unitOrthogonal(), across = contact.normal.cross(along);

  explicit Slipping(bool on_obstacle = true) : VertexOnFace(0.4) {
    contact.against_obstacle = on_obstacle;
    contacts = set();
  }

  std::vector<Vec3> slipped(double slip, double sideways = 0) const {
    std::vector<Vec3> at = x;
    at[0] += numerics.contact.stick_velocity * kSlidingStep * (slip * along + sideways * across);
    return at;
  }
  /// Calls ContactSet::update() with an iterate at this slip.
  Slipping& update(double slip, double sideways = 0) {
    contacts.update(slipped(slip, sideways), states);
    return *this;
  }
  /// Friction in the linear system at this slip, relative to the normal force.
  Vec3 friction(double slip, double sideways = 0) const {
    std::vector<Vec3> f(x.size(), Vec3::Zero());
    contacts.add_forces(ForceLaw::tangent, slipped(slip, sideways), states, f);
    return (f[0] - contact.normal.dot(f[0]) * contact.normal) / normal_force_at(0.6);
  }
  Mat3 stiffness(double slip) const {
    solver::LinearSystem system;
    system.matrix = solver::BlockMatrix(static_cast<Index>(x.size()), {});
    std::vector<Vec3> f(x.size(), Vec3::Zero());
    contacts.linearise(slipped(slip), 1, states, f, system);
    return assembled(system).topLeftCorner<3, 3>();
  }
};

TEST(ContactSet, JacobianOfSlidingIsExactWhereItGoesOnAndNeverTooSoftWhereItBegins) {
  const Mat3 sticking = Slipping().update(0).stiffness(0);
  const double scale = sticking.cwiseAbs().maxCoeff();
  const Mat3 exact = differences(Slipping().contacts, Slipping().slipped(3), 1).topLeftCorner<3, 3>();
  EXPECT_LT((Slipping().update(3).update(3).stiffness(3) - exact).norm(), 1e-4 * scale);

  const Slipping begins = Slipping().update(0.01).update(3);
  const Mat3 added = begins.stiffness(3) - exact;
  EXPECT_LT((added * begins.across).norm(), 1e-4 * scale);
  EXPECT_LT((added * begins.contact.normal).norm(), 1e-4 * scale);
  EXPECT_GT(begins.along.dot(added * begins.along), 0.05 * scale);
}

TEST(ContactSet, FrictionThatSticksFollowsItsTangentToTheLaw) {
  Slipping pair;
  pair.update(0.5).update(0.5);
  const auto law = [](double slip) { return 0.4 * slip * (2 - slip); };
  EXPECT_NEAR(pair.friction(0.5).dot(pair.along), -law(0.5), 1e-12);
  // At a slip s, the slope of law() is 0.4 (2 − 2 s) along the slip and 0.4 (2 − s) across it.
  EXPECT_NEAR(pair.friction(0.6).dot(pair.along), -(law(0.5) + 0.4 * 1.0 * 0.1), 1e-12);
  EXPECT_NEAR(pair.friction(0.5, 0.2).dot(pair.across), -0.4 * 1.5 * 0.2, 1e-12);
  for (int k = 0; k < 6; ++k) pair.update(0.6);
  EXPECT_NEAR(pair.friction(0.6).dot(pair.along), -law(0.6), 1e-12);
  EXPECT_NEAR(pair.along.dot(pair.stiffness(0.6) * pair.along),
              pair.states.normal_forces[0] * 0.4 * (2 - 2 * 0.6) / (numerics.contact.stick_velocity * kSlidingStep),
              1e-9 * pair.states.normal_forces[0] * 1e6);
}

TEST(ContactSet, FrictionThatSticksLetsGoWhereItsTangentLeadsBeyondStaticFriction) {
  Slipping pair;
  pair.contact.static_friction = 0.6;
  pair.contacts = pair.set();
  pair.update(0.5).update(0.5).update(1.5, 1);
  const FrictionState& friction = pair.states.frictions[0];
  EXPECT_FALSE(friction.sticks);
  // The tangent at the slip (0.5, 0) gives 0.6 (1.75, 1.5) at the slip (1.5, 1): 0.75 + 1.0 · 1.0 along, 1.5 · 1.0
  // across. The length of this vector is limited to the coefficient of static friction, 0.6.
  EXPECT_LT((friction.relative_friction - 0.6 * (1.75 * pair.along + 1.5 * pair.across).normalized()).norm(), 1e-12);
  EXPECT_NEAR(pair.friction(100).norm(), 0.4, 1e-12);  // sliding friction
}

TEST(ContactSet, ReversedSlipSticksAtMostTwiceInAStep) {
  Slipping pair;
  pair.update(3).update(4);
  EXPECT_FALSE(pair.states.frictions[0].sticks);
  double slip = 4;
  for (int turn = 0; turn < 3; ++turn) {
    slip = -slip;
    pair.update(slip);
    const bool sticks = turn < numerics.contact.max_resticks;
    EXPECT_EQ(pair.states.frictions[0].sticks, sticks) << turn;
    // While the contact sticks, friction follows the tangent at zero slip; otherwise it is sliding friction.
    EXPECT_NEAR(pair.friction(slip).dot(pair.along), sticks ? -0.4 * 2 * slip : std::copysign(0.4, -slip), 1e-12);
    pair.update(slip);
    EXPECT_FALSE(pair.states.frictions[0].sticks) << turn;
  }
  // In the next step, the contact can stick again.
  pair.states = {};
  pair.update(4).update(-4);
  EXPECT_TRUE(pair.states.frictions[0].sticks);
}

TEST(ContactSet, FrictionThatIsNotFoundInManyUpdatesSlidesOn) {
  Slipping pair;
  pair.update(0);
  for (int k = 1; k < numerics.newton.slow_after; ++k) pair.update(0.5 + 0.01 * k);
  EXPECT_TRUE(pair.states.frictions[0].sticks);
  const Vec3 relative_friction = pair.states.frictions[0].relative_friction;
  pair.update(0.2).update(0.3);
  EXPECT_FALSE(pair.states.frictions[0].sticks);
  EXPECT_EQ(pair.states.frictions[0].relative_friction, relative_friction);
  EXPECT_NEAR(pair.friction(0.3).dot(pair.along), -0.4 * 0.3 * (2 - 0.3), 1e-12);  // exact friction, no tangent
}

TEST(ContactSet, ClothOnClothKeepsTheFrictionOfUnchangedVelocity) {
  Slipping pair(false);
  pair.update(0.5);
  const Vec3 relative_friction = pair.states.frictions[0].relative_friction;
  pair.update(0.6).update(-0.6);
  EXPECT_FALSE(pair.states.frictions[0].sticks);
  EXPECT_EQ(pair.states.frictions[0].relative_friction, relative_friction);
  EXPECT_NEAR(pair.friction(0.6).dot(pair.along), -0.4 * 0.6 * (2 - 0.6), 1e-12);  // exact friction, no tangent
}

TEST(ContactSet, WhatIsFoundLaterSlidesUntilItIsSeenToHold) {
  Slipping pair;
  pair.update(0);
  pair.contacts.add(pair.contact);
  pair.update(0.5);
  EXPECT_FALSE(pair.states.frictions[1].sticks);
  EXPECT_EQ(pair.states.frictions[1].relative_friction, Vec3::Zero());
  EXPECT_TRUE(pair.update(0.5).states.frictions[1].sticks);
}

TEST(ContactSet, ParticleOnAnObstacleGoesIntoTheDiagonal) {
  ContactSet contacts;
  contacts.set_step(kSlidingStep);
  Contact contact;
  contact.particles = {2, 0, 0, 0};
  contact.weights = {1, 0, 0, 0};
  contact.obstacle_end = Vec3(0, 0, -1);  // at the end, the obstacle is at a height of 1 m
  contact.relative_start = Vec3(0, 0, 0.001);
  contact.depth = 0.001;
  contact.normal = Vec3::UnitZ();
  contact.range = kRange;
  contact.stiffness = 500;
  contact.friction = 0.3;
  contacts.add(contact);
  std::vector<Vec3> x(3, Vec3::Zero());
  x[2] = {0, 0, 1.0005};
  const solver::LinearSystem system = linearised(contacts, x, 1);
  EXPECT_TRUE(system.terms.empty());
  const Eigen::MatrixXd k = assembled(system);
  // The normal force is linearised at the initial depth, 1 mm.
  EXPECT_NEAR(k(8, 8), slope_at(0.001 / kRange), 1e-8);
  EXPECT_NEAR(linear_forces_of(contacts, x)[2].z(), normal_force_at(0.5) + 0.0005 * slope_at(0.5), 1e-9);
  EXPECT_EQ(k.topLeftCorner(6, 6).norm(), 0);
  EXPECT_NEAR(forces_of(contacts, x)[2].z(), normal_force_at(0.0015 / kRange), 1e-9);
}

TEST(ContactSet, TangentsFollowTheirOwnForceToTheLaw) {
  const VertexOnFace pair(0);
  const ContactSet contacts = pair.set();
  ContactStates states = states_at_start(contacts, pair.x);
  EXPECT_NEAR(states.depths[0], 0.6 * kRange, 1e-15);
  // The vertex is pressed to a depth of 0.9 kRange. The force follows the tangent at 0.6 kRange, below the exact force.
  std::vector<Vec3> x = pair.x;
  x[0] -= 0.3 * kRange * pair.contact.normal;
  std::vector<Vec3> f(4, Vec3::Zero());
  contacts.add_forces(ForceLaw::tangent, x, states, f);
  EXPECT_NEAR(f[0].norm(), normal_force_at(0.6) + 0.3 * kRange * slope_at(0.6), 1e-12);
  EXPECT_LT(f[0].norm(), normal_force_at(0.9));
  // The next tangent is taken at the depth whose exact force equals this force, not at the depth of the iterate.
  contacts.update(x, states);
  EXPECT_LT(states.depths[0], 0.89 * kRange);
  EXPECT_NEAR(normal_force_at(states.depths[0] / kRange), f[0].norm(),
              1e-8 * f[0].norm());  // accuracy of the search for this depth
  // After further updates, the depth of linearisation equals the actual depth, so that the linear force is exact.
  for (int k = 0; k < 8; ++k) contacts.update(x, states);
  EXPECT_NEAR(states.depths[0], 0.9 * kRange, 1e-8 * kRange);
  std::fill(f.begin(), f.end(), Vec3::Zero());
  contacts.add_forces(ForceLaw::tangent, x, states, f);
  EXPECT_NEAR(f[0].norm(), normal_force_at(0.9), 1e-14 * normal_force_at(0.9));
  // The vertex is lifted off: the normal force is zero, not negative, and the next tangent is taken at depth zero.
  x[0] += kRange * pair.contact.normal;
  contacts.update(x, states);
  EXPECT_EQ(states.depths[0], 0);
  EXPECT_EQ(states.normal_forces[0], 0);
}

}  // namespace
}  // namespace weft::collision
