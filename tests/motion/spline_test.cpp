#include "physics/motion/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::motion {
namespace {

using Spline1 = Spline<1>;
using Value = Spline1::Value;

// Tolerance: rounding errors of numbers up to ten.
constexpr double kRoundingOfNumbers = 1e-13;

const std::vector<double> kTimes{-0.5, 0.1, 1.7, 2.0, 4.5};

std::vector<Value> values_of(const std::vector<double>& numbers) {
  std::vector<Value> values;
  for (const double number : numbers) values.push_back(Value(number));
  return values;
}

const std::vector<Value> kValues = values_of({1, -2, 0.5, 3, 2.5});

TEST(Spline, PassesThroughItsKeys) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const Spline1 spline(interpolation, kTimes, kValues);
    for (std::size_t i = 0; i < kTimes.size(); ++i)
      EXPECT_NEAR(spline.at(kTimes[i]).value[0], kValues[i][0], kRoundingOfNumbers);
  }
}

TEST(Spline, RestsBeforeTheFirstAndFromTheLastKeyOn) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const Spline1 spline(interpolation, kTimes, kValues);
    for (const auto& [t, value] : {std::pair{-1e9, 1.0}, {-0.5 - 1e-12, 1.0}, {4.5, 2.5}, {1e9, 2.5}}) {
      EXPECT_EQ(spline.at(t).value[0], value);
      EXPECT_EQ(spline.at(t).first_derivative[0], 0);
      EXPECT_EQ(spline.at(t).second_derivative[0], 0);
    }
    EXPECT_NE(spline.at(-0.5).first_derivative[0], 0);
  }
}

TEST(Spline, OfOneKeyStands) {
  const Spline1 spline(Interpolation::cubic, {2}, values_of({7}));
  for (const double t : {0.0, 2.0, 5.0}) {
    EXPECT_EQ(spline.at(t).value[0], 7);
    EXPECT_EQ(spline.at(t).first_derivative[0], 0);
  }
}

TEST(Spline, HasTheIntegralOfItsValues) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const Spline1 spline(interpolation, kTimes, kValues);
    const double d = 1e-4;
    for (double t = -1.03; t < 6; t += 0.1)
      // Tolerance: the central difference errs by d²/6 times the second derivative, about 100; no key is within d.
      EXPECT_NEAR(spline.integral(t - d, t + d)[0] / (2 * d), spline.at(t).value[0], 1e-6) << t;
  }
  const Spline1 line(Interpolation::linear, {0, 2, 3}, values_of({1, 5, 4}));
  EXPECT_NEAR(line.integral(-1, 0)[0], 1, kRoundingOfNumbers);
  EXPECT_NEAR(line.integral(0, 3)[0], 10.5, kRoundingOfNumbers);
  EXPECT_NEAR(line.integral(2.5, 1)[0], -6.375, kRoundingOfNumbers);
  EXPECT_NEAR(line.integral(3, 5)[0], 8, kRoundingOfNumbers);
  EXPECT_EQ(Spline1(Interpolation::cubic, {2}, values_of({7})).integral(0, 3)[0], 21);
}

TEST(LinearSpline, GoesStraightWithTheSlopeOfTheLaterSegmentAtAKey) {
  const Spline1 spline(Interpolation::linear, {0, 2, 3}, values_of({1, 5, 4}));
  EXPECT_EQ(spline.at(0.5).value[0], 2);
  EXPECT_EQ(spline.at(0.5).first_derivative[0], 2);
  EXPECT_EQ(spline.at(2).first_derivative[0], -1);
  EXPECT_EQ(spline.at(2.5).value[0], 4.5);
  EXPECT_EQ(spline.at(2.5).second_derivative[0], 0);
}

TEST(CubicSpline, OfTwoKeysIsALine) {
  const Spline1 spline(Interpolation::cubic, {1, 3}, values_of({0, 4}));
  EXPECT_NEAR(spline.at(1.5).value[0], 1, kRoundingOfNumbers);
  EXPECT_NEAR(spline.at(1.5).first_derivative[0], 2, kRoundingOfNumbers);
}

TEST(CubicSpline, OfThreeKeysIsTheKnownNaturalSpline) {
  // Natural spline through 0, 1, 0 at 0, 1, 2: on [0, 1] it is (3t - t³)/2.
  const Spline1 spline(Interpolation::cubic, {0, 1, 2}, values_of({0, 1, 0}));
  for (const double t : {0.0, 0.25, 0.5, 0.999}) {
    EXPECT_NEAR(spline.at(t).value[0], (3 * t - t * t * t) / 2, kRoundingOfNumbers);
    EXPECT_NEAR(spline.at(t).first_derivative[0], (3 - 3 * t * t) / 2, kRoundingOfNumbers);
    EXPECT_NEAR(spline.at(t).second_derivative[0], -3 * t, kRoundingOfNumbers);
  }
}

TEST(CubicSpline, HasContinuousFirstAndSecondDerivativesAndStraightEndsWhereNothingIsLimited) {
  const Spline1 spline(Interpolation::cubic, kTimes, values_of({0, 0.7, 2.1, 2.4, 4.6}));
  for (std::size_t i = 1; i + 1 < kTimes.size(); ++i) {
    const double before = std::nextafter(kTimes[i], -1);
    EXPECT_NEAR(spline.at(before).first_derivative[0], spline.at(kTimes[i]).first_derivative[0], kRoundingOfNumbers);
    EXPECT_NEAR(spline.at(before).second_derivative[0], spline.at(kTimes[i]).second_derivative[0],
                10 * kRoundingOfNumbers);
  }
  EXPECT_NEAR(spline.at(-0.5).second_derivative[0], 0, 10 * kRoundingOfNumbers);
  EXPECT_NEAR(spline.at(std::nextafter(4.5, 0)).second_derivative[0], 0, 10 * kRoundingOfNumbers);
}

TEST(CubicSpline, StandsBetweenEqualKeysAndStaysBetweenOthers) {
  const std::vector<double> times{0, 0.5, 2.5, 2.8, 4, 4.1};
  const std::vector<double> numbers{1, 1, -3, -2.9, 5, 5};
  const Spline1 spline(Interpolation::cubic, times, values_of(numbers));
  double slope_before = 0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const auto [low, high] = std::minmax(numbers[i], numbers[i + 1]);
    EXPECT_NEAR(spline.at(times[i]).first_derivative[0], slope_before, 10 * kRoundingOfNumbers) << "at key " << i;
    for (double fraction = 0; fraction < 1; fraction += 0.01) {
      const Spline1::Sample at = spline.at(times[i] + fraction * (times[i + 1] - times[i]));
      EXPECT_GE(at.value[0], low - kRoundingOfNumbers) << "after key " << i;
      EXPECT_LE(at.value[0], high + kRoundingOfNumbers) << "after key " << i;
      EXPECT_GE(at.first_derivative[0] * (numbers[i + 1] - numbers[i]), -10 * kRoundingOfNumbers)
          << "turns back after " << i;
    }
    slope_before = spline.at(std::nextafter(times[i + 1], 0)).first_derivative[0];
  }
}

TEST(CubicSpline, ReproducesALineThroughUnevenKeysInEveryComponent) {
  std::vector<Vec3> points;
  for (const double t : kTimes) points.emplace_back(1 + 2 * t, -t, 3);
  const Spline<3> spline(Interpolation::cubic, kTimes, points);
  for (const double t : {-0.3, 0.9, 1.8, 3.3}) {
    EXPECT_NEAR((spline.at(t).value - Vec3(1 + 2 * t, -t, 3)).norm(), 0, kRoundingOfNumbers);
    EXPECT_NEAR((spline.at(t).first_derivative - Vec3(2, -1, 0)).norm(), 0, kRoundingOfNumbers);
  }
}

TEST(CubicSpline, HasTheDerivativesThatItsValuesShow) {
  const Spline1 spline(Interpolation::cubic, kTimes, kValues);
  // Tolerance: a central difference of a cubic has an error of h² / 6 times its third derivative, which is below 100,
  // plus the rounding error 1e-15 / h.
  const double h = 1e-5, tolerance = 2e-8;
  for (const double t : {-0.2, 0.5, 1.2, 1.9, 2.1, 4.0}) {
    const auto slope = [&](auto member) {
      return ((spline.at(t + h).*member)[0] - (spline.at(t - h).*member)[0]) / (2 * h);
    };
    EXPECT_NEAR(slope(&Spline1::Sample::value), spline.at(t).first_derivative[0], tolerance);
    EXPECT_NEAR(slope(&Spline1::Sample::first_derivative), spline.at(t).second_derivative[0], tolerance);
  }
}

}  // namespace
}  // namespace weft::motion
