// The limit at which woven threads lock.
#include "physics/forces/stretch_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "forces/sheets.hpp"

namespace weft::forces {
namespace {

using testing::kGrid;
using testing::kHeight;
using testing::kWidth;
using testing::Positions;

constexpr double kLimit = 0.1;
const double kSine = std::sin(0.5);
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr StretchParameters kBelow{2000, 1000};

// A sheet whose threads have these lengths along weft and warp, relative to rest. `sine`: sine of the shear angle, by
// which the angle between weft and warp deviates from 90 degrees.
Positions drawn(double weft, double warp, double sine = 0) {
  const double cosine = std::sqrt(1 - sine * sine);
  return testing::shaped(kGrid,
                         [=](double u, double v) { return Vec3(weft * u + sine * warp * v, cosine * warp * v, 0); });
}

// Limits with the same parameters, for quads and for triangles.
std::vector<std::unique_ptr<StretchLimit>> both(double stretch, double shear) {
  std::vector<std::unique_ptr<StretchLimit>> limits;
  limits.push_back(std::make_unique<StretchLimit>(kGrid, 0, kBelow, stretch, shear));
  const mesh::Sheet sheet = mesh::make_sheet_from_mesh(mesh::make_triangle_sheet(kGrid, mesh::Pattern::aligned));
  limits.push_back(std::make_unique<StretchLimit>(TriangleMembrane(sheet, 0, {}, {}), kBelow, stretch, shear));
  return limits;
}

// Integrates the stress by the midpoint rule. The stress has a continuous derivative, so the error is of second order.
double integral(const Lock& lock, double to) {
  constexpr int kPieces = 10000;
  double sum = 0;
  for (int i = 0; i < kPieces; ++i) sum += lock.stress((i + 0.5) * to / kPieces) * to / kPieces;
  return sum;
}

TEST(Lock, HasAStressThatIsTheDerivativeOfItsEnergyAndAStiffnessWithoutAJump) {
  const Lock lock(kLimit);
  for (double strain : {0.02, 0.08, 0.1, 0.13, 0.5})
    EXPECT_NEAR(lock.energy(strain), integral(lock, strain), 1e-6 * lock.energy(strain)) << strain;
  constexpr double kStep = 1e-7;
  for (double strain : {0.075, 0.09, 0.12}) {
    const double slope = (lock.stress(strain + kStep) - lock.stress(strain - kStep)) / (2 * kStep);
    EXPECT_NEAR(lock.stiffness(strain), slope, 1e-5 * slope) << strain;
  }
  for (double strain : {lock.onset(), kLimit}) {
    EXPECT_NEAR(lock.stress(strain - 1e-12), lock.stress(strain + 1e-12), 1e-5);
    EXPECT_NEAR(lock.stiffness(strain - 1e-12), lock.stiffness(strain + 1e-12), 1e-9 * lock.stiffness(kLimit));
  }
  EXPECT_EQ(lock.stress(kLimit), Lock::kTension);
}

TEST(StretchLimit, IsNothingBelowItsOnsetToTheBit) {
  const double below = 1 + Lock::kOnset * kLimit * (1 - 1e-9),
               square = Lock::kOnset * kSine / (below * below) * (1 - 1e-9);
  for (const auto& limit : both(kLimit, kSine))
    for (const Positions& x : {drawn(below, 0.3), drawn(0.3, below), drawn(below, below, square)}) {
      for (const Vec3& f : testing::force_of(*limit, x, testing::zeros(x))) EXPECT_EQ(f, Vec3::Zero());
      EXPECT_EQ(limit->energy(x), 0);
      EXPECT_TRUE(testing::stiffness_of(*limit, x, testing::zeros(x), 100).isZero(0));
    }
}

TEST(StretchLimit, OfUniformStrainHasTheEnergyOfTheContinuumOnQuadsAndTriangles) {
  const double area = kWidth * kHeight, extension = 0.093;
  const Lock stretch(kLimit), shear(kSine);
  for (const auto& limit : both(kLimit, kSine)) {
    EXPECT_NEAR(limit->energy(drawn(1 + extension, 1)), area * stretch.energy(extension),
                1e-10 * area * Lock::kTension);
    EXPECT_NEAR(limit->energy(drawn(1, 1 + extension)), area * stretch.energy(extension),
                1e-10 * area * Lock::kTension);
    EXPECT_NEAR(limit->energy(drawn(1, 1, -0.45)), area * shear.energy(0.45), 1e-10 * area * Lock::kTension);
  }
}

TEST(StretchLimit, OfShearAloneOrOfStretchAloneLeavesTheOther) {
  for (const auto& limit : both(kLimit, kNone)) EXPECT_EQ(limit->energy(drawn(1, 1, 0.9)), 0);
  for (const auto& limit : both(kNone, kSine)) EXPECT_EQ(limit->energy(drawn(1.5, 1.5)), 0);
}

/// The force plus what its linearisation adds [N].
Positions linear_force(const StretchLimit& limit, const Positions& x, const LockLinearisation& linearisation) {
  Positions force = testing::force_of(limit, x, testing::zeros(x));
  limit.add_linearisation_difference(x, linearisation, force);
  return force;
}

TEST(StretchLimit, IsLinearisedWhereItsThreadsHaveTheTensionForeseen) {
  const Lock lock(kLimit);
  for (const auto& limit : both(kLimit, kNone)) {
    const Positions start = drawn(1.08, 1.02), far = drawn(1.2, 1.02);
    LockLinearisation linearisation;
    limit->begin(start, linearisation);
    limit->update(far, true, linearisation);
    const Positions itself = testing::force_of(*limit, far, testing::zeros(far));
    const Positions linear = linear_force(*limit, far, linearisation);
    const double foreseen = lock.stress(0.08) + 0.12 * lock.stiffness(0.08);
    for (std::size_t i = 0; i < far.size(); ++i)
      EXPECT_LT((linear[i] - foreseen / lock.stress(0.2) * itself[i]).norm(), 1e-9 * Lock::kTension) << i;
    limit->update(far, false, linearisation);
    const double tension = kBelow.weft * 0.2 + foreseen;
    ASSERT_FALSE(linearisation.beyond_onset.empty());
    for (const std::uint32_t t : linearisation.beyond_onset) {
      const double e = linearisation.extensions[t];
      EXPECT_LT(e, 0.2);
      // Tolerance: twice kExtensionTolerance (stretch_limit.cpp).
      EXPECT_NEAR(kBelow.weft * e + lock.stress(e), tension, 2e-3 * tension);
    }
    EXPECT_TRUE(std::ranges::all_of(linear_force(*limit, drawn(0, 1.02), linearisation), [](const Vec3& f) {
      return f.isZero(0);
    })) << "threads without a length";
  }
}

TEST(StretchLimit, IsItselfWhereItIsLinearisedAndBelowTheOnset) {
  for (const auto& limit : both(kLimit, kNone))
    for (const double weft : {1.02, 1.09, 1.3}) {
      const Positions x = drawn(weft, 1.01);
      LockLinearisation linearisation;
      limit->begin(x, linearisation);
      limit->update(x, true, linearisation);
      EXPECT_EQ(linearisation.beyond_onset.empty(), weft < 1.05);
      const Positions force = testing::force_of(*limit, x, testing::zeros(x)),
                      linear = linear_force(*limit, x, linearisation);
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((linear[i] - force[i]).norm(), 1e-9 * Lock::kTension);
    }
}

TEST(StretchLimit, TellsTheLongestThreadAndWhereItIs) {
  for (const auto& limit : both(kLimit, kNone)) {
    Positions x = drawn(1, 0.9);
    EXPECT_EQ(limit->worst(drawn(0.9, 0.9)).extension, 0);
    x[kGrid.index(4, 3)].x() += 0.02 * kGrid.lu;
    EXPECT_NEAR(limit->worst(x).extension, 0.02, 1e-12);
    EXPECT_LT((limit->worst(x).place - x[kGrid.index(4, 3)]).norm(), kGrid.lu);
  }
}

}  // namespace
}  // namespace weft::forces
