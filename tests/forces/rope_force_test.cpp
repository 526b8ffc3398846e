// Compares the forces within ropes with closed forms.
#include "physics/forces/rope_force.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::Positions;

constexpr int kPieces = 200;
constexpr double kLength = 0.5;  // [m]

std::vector<double> even_pieces() {
  return std::vector<double>(kPieces, kLength / kPieces);
}

Positions arc(double radius, double length = kLength) {
  Positions x;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = length / radius * i / kPieces;
    x.emplace_back(radius * std::sin(angle), 0.2, radius * std::cos(angle));
  }
  return x;
}

TEST(RopeForce, EnergyOfAnArcIsThatOfABeam) {
  // The expected energy is ½ EI L / R², where L is one piece less than the rope, because only inner particles have
  // curvature. Tolerance: a piece of 2.5 mm on a radius of 0.1 m turns by 0.025 rad; the energy is too small by a sixth
  // of the square of this angle.
  const RopeForce rope_force(even_pieces(), false, 0, {.bend = 3e-4});
  const double expected = 0.5 * 3e-4 * (kLength - kLength / kPieces) / (0.1 * 0.1);
  EXPECT_NEAR(rope_force.energy(arc(0.1)) / expected, 1, 1.1e-4);
}

TEST(RopeForce, PullsByItsStiffnessTimesItsStrain) {
  const RopeForce rope_force(even_pieces(), false, 0, {.stretch = 5000});
  Positions x;
  for (int i = 0; i <= kPieces; ++i) x.emplace_back(1.02 * kLength * i / kPieces, 0, 0);
  const Positions f = testing::force_of(rope_force, x, testing::zeros(x));
  EXPECT_NEAR(f.front().x(), 0.02 * 5000, 1e-9);
  EXPECT_NEAR(f.back().x(), -0.02 * 5000, 1e-9);
  EXPECT_NEAR(rope_force.max_strain(x), 0.02, 1e-12);
}

TEST(RopeForce, PullsMoreWhereKeysMakeItShorter) {
  RopeForce rope_force(even_pieces(), false, 0, {.stretch = 5000});
  Positions x;
  for (int i = 0; i <= kPieces; ++i) x.emplace_back(kLength * i / kPieces, 0, 0);
  rope_force.set_length_ratio(0.8);
  EXPECT_NEAR(testing::force_of(rope_force, x, testing::zeros(x)).front().x(), 5000 * (1 / 0.8 - 1), 1e-9);
}

TEST(RopeForce, KeepsItsBendingStiffnessWhereKeysMakeItShorter) {
  RopeForce rope_force(even_pieces(), false, 0, {.bend = 3e-4});
  EXPECT_TRUE(rope_force.set_length_ratio(0.4));
  EXPECT_FALSE(rope_force.set_length_ratio(0.4));
  rope_force.set_held(std::vector<char>(kPieces + 1, 0));
  const double length = 0.4 * kLength, expected = 0.5 * 3e-4 * (length - length / kPieces) / (0.1 * 0.1);
  EXPECT_NEAR(rope_force.energy(arc(0.1, length)) / expected, 1, 1.1e-4);
}

TEST(RopeForce, MeetsAirAcrossAsACylinderAndNotAlong) {
  const RopeForce rope_force(even_pieces(), false, 0, {.air_density = 1.2, .drag = 1.1, .diameter = 0.01});
  Positions x;
  for (int i = 0; i <= kPieces; ++i) x.emplace_back(kLength * i / kPieces, 0, 0);
  const Positions f = testing::force_of(rope_force, x, Positions(x.size(), Vec3(7, 3, 4)));
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : f) sum += force;
  // The expected drag is ½ ρ c d L v², where v is the component of the velocity across the rope, 5 m/s.
  const double drag = 0.5 * 1.2 * 1.1 * 0.01 * kLength * 25;
  EXPECT_LT((sum - drag * Vec3(0, -0.6, -0.8)).norm(), 1e-9 * drag);
}

TEST(RopeForce, HasHalfOfTheMassOfItsPiecesAtTheirEnds) {
  const std::vector<double> lengths{0.1, 0.3};
  EXPECT_EQ(lumped_masses(lengths, false, 2), (std::vector<double>{0.1, 0.4, 0.3}));
  EXPECT_EQ(lumped_masses(lengths, true, 2), (std::vector<double>{0.4, 0.4}));
}

TEST(RopeForce, TurnsRigidlyWithoutResistance) {
  const RopeForce rope_force(even_pieces(), false, 0,
                             {.stretch = 100, .stretch_viscosity = 5, .bend = 1e-3, .bend_viscosity = 1e-3});
  const Positions x = arc(0.1);
  Positions spinning;
  for (const Vec3& place : x) spinning.push_back(Vec3(3, -2, 5).cross(place));
  const Positions still = testing::force_of(rope_force, x, testing::zeros(x)),
                  turning = testing::force_of(rope_force, x, spinning);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((turning[i] - still[i]).norm(), 1e-9);
}

}  // namespace
}  // namespace weft::forces
