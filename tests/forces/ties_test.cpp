// Buttons and zips.
#include "physics/forces/ties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft::forces {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kPull = 2;  // [N]

Ties tie_of(double open, double closed) {
  mesh::Sheet sheet;
  sheet.ties.push_back({.a = 0, .b = 1, .strength = kPull, .open = open, .closed = closed});
  return {sheet, 0, 1e-9};
}
// Force between two particles at this distance [m], from the gradient of the energy [N]. Its error is below 1e-10 N:
// energies of about 1e-3 J have rounding errors of 1e-19 J, and the difference divides them by 2e-8 m.
double pull(const Ties& ties, double distance) {
  constexpr double kStep = 1e-8;
  const auto energy = [&](double x) { return ties.energy(std::vector<Vec3>{Vec3(0, 0, 0), Vec3(0, x, 0)}); };
  return (energy(distance + kStep) - energy(distance - kStep)) / (2 * kStep);
}

TEST(Ties, PullUpToTheirStrengthAndDoNotPush) {
  Ties ties = tie_of(kNever, kNever);
  ties.set_strengths(0, 1);
  EXPECT_EQ(pull(ties, 0.5 * Ties::kRest), 0);
  EXPECT_NEAR(pull(ties, 1.5 * Ties::kRest), 0.5 * kPull, 1e-6);
  EXPECT_NEAR(pull(ties, 5 * Ties::kRest), kPull, 1e-6);
  ties.set_strengths(0, 0.25);  // during sewing
  EXPECT_NEAR(pull(ties, 5 * Ties::kRest), 0.25 * kPull, 1e-6);
}

TEST(Ties, ForceIsMinusTheGradientOfTheEnergy) {
  Ties ties = tie_of(kNever, kNever);
  ties.set_strengths(0, 1);
  for (const double distance : {0.5, 1.5, 5.0}) {
    std::vector<solver::PaddedVec3<double>> x{solver::padded<double>(Vec3(0, 0, 0)),
                                              solver::padded<double>(Vec3(0, distance * Ties::kRest, 0))};
    std::vector<solver::PaddedVec3<double>> v(2), force(2);
    ties.add({.x = x, .v = v, .force = force});
    EXPECT_NEAR(force[0][1], pull(ties, distance * Ties::kRest), 1e-6);
    EXPECT_EQ(force[0][1], -force[1][1]);
  }
}

TEST(Ties, KnowWhetherTheyOpenOrCloseBetweenTwoTimes) {
  const Ties ties = tie_of(3, 1);
  EXPECT_TRUE(ties.are_constant_between(0, 0.9));
  EXPECT_FALSE(ties.are_constant_between(0.9, 1.1));
  EXPECT_FALSE(ties.are_constant_between(1.1, 1.2));  // its strength grows
  EXPECT_TRUE(ties.are_constant_between(2, 2.9));
  EXPECT_FALSE(ties.are_constant_between(2.9, 3));
}

TEST(Ties, AreOpenAndClosedAtTheirTimes) {
  const auto held = [](double open, double closed, double t) {
    Ties ties = tie_of(open, closed);
    ties.set_strengths(t, 1);
    return pull(ties, 1);
  };
  constexpr double kAfter = 1 + Ties::kClosing;  // time when a tie that closes at 1 s has its full strength [s]
  EXPECT_NEAR(held(kNever, kNever, -5), kPull, 1e-6);
  EXPECT_NEAR(held(1, kNever, 0.99), kPull, 1e-6);
  EXPECT_EQ(held(1, kNever, 1), 0);
  EXPECT_EQ(held(1, kNever, std::nextafter(1.0, 0.0)), 0) << "a sum of step lengths";
  EXPECT_EQ(held(kNever, 1, 0.99), 0);
  EXPECT_NEAR(held(kNever, 1, 1 + 0.5 * Ties::kClosing), 0.5 * kPull, 1e-6);
  EXPECT_NEAR(held(kNever, 1, kAfter), kPull, 1e-6);
  // This tie closes at 1 s and opens at 3 s.
  EXPECT_EQ(held(3, 1, 0), 0);
  EXPECT_NEAR(held(3, 1, kAfter), kPull, 1e-6);
  EXPECT_EQ(held(3, 1, 3), 0);
  // This tie opens at 0.5 s and closes at 1 s.
  EXPECT_NEAR(held(0.5, 1, 0), kPull, 1e-6);
  EXPECT_EQ(held(0.5, 1, 0.5), 0);
  EXPECT_NEAR(held(0.5, 1, kAfter), kPull, 1e-6);
}

TEST(Ties, OfSeamsThatTearPartForGoodOnceTheyHaveHeld) {
  mesh::Sheet sheet;
  sheet.tearing_seams = {"side"};
  sheet.ties.push_back({.a = 0, .b = 1, .strength = kPull, .tearing = 0});
  Ties ties(sheet, 0, 1e-9);
  const auto accept = [&](double distance) {
    const std::vector<Vec3> x{Vec3(0, 0, 0), Vec3(0, distance * Ties::kRest, 0)};
    ties.accept(x);
    return ties.measure_seams(x).at(0);
  };
  ties.set_strengths(0, 0.5);
  accept(1.5);
  ties.set_strengths(0, 1);
  EXPECT_TRUE(accept(5).is_closed) << "was sewn already, but had not held yet";
  EXPECT_NEAR(accept(1.5).load, 0.5 * kPull, 1e-12);
  EXPECT_FALSE(accept(2).is_closed);
  EXPECT_EQ(accept(1.5).load, 0);
  ties.set_strengths(0, 1);
  EXPECT_EQ(pull(ties, 1.5 * Ties::kRest), 0);
  Ties others(sheet, 0, 1e-9);
  others.copy_state_from(ties);
  others.set_strengths(0, 1);
  EXPECT_EQ(pull(others, 1.5 * Ties::kRest), 0);
}

TEST(Ties, OfSeamsThatTearMayOpenAndCloseAgain) {
  mesh::Sheet sheet;
  sheet.tearing_seams = {"side"};
  sheet.ties.push_back({.a = 0, .b = 1, .strength = kPull, .tearing = 0, .open = 1, .closed = 2});
  Ties ties(sheet, 0, 1e-9);
  const auto accept = [&](double t, double distance) {
    const std::vector<Vec3> x{Vec3(0, 0, 0), Vec3(0, distance * Ties::kRest, 0)};
    ties.set_strengths(t, 1);
    ties.accept(x);
    return ties.measure_seams(x).at(0).is_closed;
  };
  EXPECT_TRUE(accept(0.5, 1.5));
  EXPECT_FALSE(accept(1.5, 5)) << "is open";
  EXPECT_TRUE(accept(2 + Ties::kClosing, 5)) << "draws its ends together and has not torn";
  EXPECT_TRUE(accept(3, 1.5));
  EXPECT_FALSE(accept(3.1, 5)) << "is torn";
}

}  // namespace
}  // namespace weft::forces
