// Tests of the order of convergence of each method, on a smooth nonlinear motion.
#include <gtest/gtest.h>

#include <functional>

#include "integrator/small_systems.hpp"
#include "physics/integrator/stepper.hpp"

namespace weft::integrator {
namespace {

// Newton tolerance [m/s²]: above the rounding error of x / h², 2e-11, and far below the errors of the methods, 1e-6.
constexpr NewtonParameters kSolved{.tolerance = 1e-9, .max_iterations = 40, .linear_tolerance = 1e-12};

const Vec3 kStartX(1, 0.2, -0.3), kStartV(0.1, 0.8, 0.4);
constexpr double kEnd = 1.5;  // [s]
using Law = std::function<Vec3(const Vec3& x, const Vec3& v)>;

// Position at kEnd by the classical Runge-Kutta method. Its error, of the order of h⁴ = 2e-14, is negligible.
Vec3 reference(const Law& acceleration) {
  constexpr int kSteps = 4000;
  const double h = kEnd / kSteps;
  Vec3 x = kStartX, v = kStartV;
  for (int s = 0; s < kSteps; ++s) {
    const Vec3 v1 = v, a1 = acceleration(x, v1);
    const Vec3 v2 = v + 0.5 * h * a1, a2 = acceleration(x + 0.5 * h * v1, v2);
    const Vec3 v3 = v + 0.5 * h * a2, a3 = acceleration(x + 0.5 * h * v2, v3);
    const Vec3 v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

// End position of a run over the given steps, which add up to kEnd.
Vec3 run(testing::Particles& system, Method method, const std::vector<double>& steps) {
  Stepper stepper(method, kSolved);
  State now{{kStartX}, {kStartV}}, next;
  for (double h : steps) {
    const StepReport report = stepper.step(system, now, h, Vec3::Zero(), {}, next);
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

void expect_order(testing::Particles&& system, const Law& law, Method method, double order, Steps steps) {
  const Vec3 exact = reference(law);
  double coarse = (run(system, method, steps(80)) - exact).norm();
  for (int count : {160, 320}) {
    const double fine = (run(system, method, steps(count)) - exact).norm();
    // Tolerance: the next term of the error is of the order of h times the first one, here a few per cent.
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.1) << count << " steps";
    coarse = fine;
  }
}

Vec3 undamped(const Vec3& x, const Vec3&) {
  return testing::HardeningSpring::force_at(x);
}
TEST(Order, ImplicitEulerConvergesWithOrderOne) {
  expect_order(testing::HardeningSpring(), undamped, Method::implicit_euler, 1, equal_steps);
}
TEST(Order, ImplicitMidpointConvergesWithOrderTwo) {
  expect_order(testing::HardeningSpring(), undamped, Method::implicit_midpoint, 2, equal_steps);
}
TEST(Order, Bdf2ConvergesWithOrderTwo) {
  expect_order(testing::HardeningSpring(), undamped, Method::bdf2, 2, equal_steps);
}
TEST(Order, Bdf2ConvergesWithOrderTwoWhereStepsAreUneven) {
  expect_order(testing::HardeningSpring(), undamped, Method::bdf2, 2, uneven_steps);
}
}  // namespace
}  // namespace weft::integrator
