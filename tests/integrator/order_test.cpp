// Tests of the order of convergence of each method, on a smooth nonlinear motion.
#include <gtest/gtest.h>

#include "integrator/small_systems.hpp"
#include "physics/integrator/stepper.hpp"

namespace weft::integrator {
namespace {

// Newton tolerance [m/s²]: above the rounding error of x / h², 2e-11, and far below the errors of the methods, 1e-6.
constexpr NewtonParameters kSolved{.tolerance = 1e-9, .max_iterations = 40, .linear_tolerance = 1e-12};

const State kFirst{{Vec3(1, 0.2, -0.3)}, {Vec3(0.1, 0.8, 0.4)}};
constexpr double kEnd = 1.5;  // [s]

// End position of a run over the given steps, which add up to kEnd.
Vec3 run(Method method, const std::vector<double>& steps) {
  testing::HardeningSpring spring;
  Stepper stepper(method, kSolved);
  State now = kFirst, next;
  for (double h : steps) {
    const StepReport report = stepper.step(spring, now, h, Vec3::Zero(), {}, next);
    EXPECT_EQ(report.verdict, Verdict::solved) << describe(report.verdict);
    stepper.accept(now, next, h);
    std::swap(now, next);
  }
  return now.x[0];
}

std::vector<double> equal_steps(int count) {
  return std::vector<double>(static_cast<std::size_t>(count), kEnd / count);
}

// Alternately short and long steps with a ratio of two, as if steps were halved and then doubled.
std::vector<double> uneven_steps(int count) {
  std::vector<double> steps;
  for (int s = 0; s < count; ++s) steps.push_back(kEnd / count * (s % 2 ? 4.0 / 3 : 2.0 / 3));
  return steps;
}

using Steps = std::vector<double> (*)(int count);

void expect_order(Method method, double order, Steps steps) {
  // The error of the reference, of the order of h⁴ = 2e-14, is negligible.
  const Vec3 exact = testing::moved(kFirst, kEnd, 4000).x[0];
  double coarse = (run(method, steps(80)) - exact).norm();
  for (int count : {160, 320}) {
    const double fine = (run(method, steps(count)) - exact).norm();
    // Tolerance: the next term of the error is of the order of h times the first one, here a few per cent.
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.1) << count << " steps";
    coarse = fine;
  }
}

TEST(Order, ImplicitEulerConvergesWithOrderOne) {
  expect_order(Method::implicit_euler, 1, equal_steps);
}
TEST(Order, ImplicitMidpointConvergesWithOrderTwo) {
  expect_order(Method::implicit_midpoint, 2, equal_steps);
}
TEST(Order, Bdf2ConvergesWithOrderTwo) {
  expect_order(Method::bdf2, 2, equal_steps);
}
TEST(Order, Bdf2ConvergesWithOrderTwoWhereStepsAreUneven) {
  expect_order(Method::bdf2, 2, uneven_steps);
}
}  // namespace
}  // namespace weft::integrator
