// Tests of gusts: strength, zero divergence, length scale and duration.
#include "physics/model/gusts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::model {
namespace {

const Gusts kGusts{.speed = 2, .size = 1.5, .seed = 7};
const Vec3 kWind(6, 1, 0);

// Relative tolerance of means over 8,000 places. The places are several length scales apart and thus independent; the
// tolerance is a few times 1/√8000.
constexpr double kOfMeans = 0.05;

/// Calls body(x) for places on a lattice. Its spacings are no multiples of any wave length.
template <class Body>
void for_places(const Body& body) {
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k) body(Vec3(7.31 * i, 5.77 * j, 6.13 * k));
}

TEST(Gusts, AreAsStrongAsIsSaidInEveryDirectionAndNothingOnTheWhole) {
  const GustField gusts(kGusts, kWind);
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for_places([&](const Vec3& x) {
    const Vec3 v = gusts.at(x, 3);
    sum += v;
    squares += v.cwiseAbs2();
  });
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / 8000, 0, kOfMeans * kGusts.speed);
    EXPECT_NEAR(std::sqrt(squares[axis] / 8000), kGusts.speed, kOfMeans * kGusts.speed);
  }
}

TEST(Gusts, HaveNoDivergence) {
  const GustField gusts(kGusts, kWind);
  // Tolerance: central differences have errors of h²/6 times third derivatives of about speed · k³, with wave numbers k
  // up to 30 1/m, plus rounding errors of 1e-15 / h.
  const double h = 1e-5;
  double largest = 0;
  for_places([&](const Vec3& x) {
    double divergence = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 e = h * Vec3::Unit(axis);
      divergence += (gusts.at(x + e, 1)[axis] - gusts.at(x - e, 1)[axis]) / (2 * h);
      largest = std::max(largest, std::abs(gusts.at(x + e, 1)[axis] - gusts.at(x - e, 1)[axis]) / (2 * h));
    }
    EXPECT_NEAR(divergence, 0, 1e-6);
  });
  EXPECT_GT(largest, 1) << "there is something to cancel";
}

// The integral length scale is the correlation of each component along its own direction, integrated until it vanishes.
TEST(Gusts, AreOfTheSizeThatIsSaid) {
  constexpr int kFields = 10, kPlaces = 400, kSteps = 40;
  const double d = 0.15 * kGusts.size;
  double sum = 0;
  for (int seed = 0; seed < kFields; ++seed) {
    const GustField gusts({kGusts.speed, kGusts.size, seed}, Vec3::Zero());
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < kPlaces; ++i) {
        const Vec3 x(7.3 * i, 3.1 * i, 11.7 * i);
        double along = 0;
        for (int step = 0; step < kSteps; ++step)
          along += (step == 0 ? 0.5 : 1) * gusts.at(x + step * d * Vec3::Unit(axis), 0)[axis];
        sum += d * gusts.at(x, 0)[axis] * along;
      }
  }
  const double length = sum / (kFields * 3 * kPlaces) / (kGusts.speed * kGusts.speed);
  // Tolerance: statistical error of the mean of ten fields in three directions, and the discrete spectrum, in which
  // wave lengths of neighbouring shells differ by a third.
  EXPECT_NEAR(length, kGusts.size, 0.2 * kGusts.size);
}

TEST(Gusts, AreCarriedAlongByTheWind) {
  const GustField gusts(kGusts, kWind);
  double carried = 0, left = 0;
  const double later = 0.05;  // much shorter than the lifetime of an eddy of that size, 0.75 s
  for_places([&](const Vec3& x) {
    carried += (gusts.at(x + later * kWind, later) - gusts.at(x, 0)).squaredNorm();
    left += (gusts.at(x, later) - gusts.at(x, 0)).squaredNorm();
  });
  EXPECT_LT(carried, 0.1 * left);
}

TEST(Gusts, AreTheSameForASeedAndOthersForAnother) {
  const Vec3 x(1, 2, 3);
  EXPECT_EQ(GustField(kGusts, kWind).at(x, 4), GustField(kGusts, kWind).at(x, 4));
  EXPECT_GT((GustField({2, 1.5, 8}, kWind).at(x, 4) - GustField(kGusts, kWind).at(x, 4)).norm(), 0.1);
}

}  // namespace
}  // namespace weft::model
