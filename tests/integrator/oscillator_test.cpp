// Compares every method with its exact damping and phase on x'' = −ω² x.
//
// With w = ω x + i v, the equation is w' = −i ω w, and each step of a method is w(next) = z w. Damping is ‖z‖ and phase
// is −arg(z) / y with y = ω h. Both are 1 for the exact solution.
#include <gtest/gtest.h>

#include <complex>
#include <string>

#include "integrator/small_systems.hpp"
#include "physics/integrator/stepper.hpp"

namespace weft::integrator {
namespace {

using namespace std::complex_literals;
using Complex = std::complex<double>;
using testing::kTight;

// Relative tolerance of damping and phase. (Measured errors are below 1e-12.)
constexpr double kTolerance = 1e-6;
constexpr double kStep = 0.01;                     // [s]
constexpr double kProducts[] = {0.1, 1, 10, 100};  // values of y

// State with the given w, along an oblique direction, so that all three axes contribute.
const Vec3 kDirection = Vec3(1, -2, 2) / 3;
State state_of(Complex w, double omega) {
  return {{Vec3(w.real() / omega * kDirection)}, {Vec3(w.imag() * kDirection)}};
}
Complex number_of(const State& state, double omega) {
  return {omega * kDirection.dot(state.x[0]), kDirection.dot(state.v[0])};
}

// w after a step over h from w = `now`. `before`: w at the start of the previous step, over before_h [s], which is the
// history of BDF2.
Complex stepped(Method method, double omega, double h, Complex now, const Complex* before = nullptr,
                double before_h = 0) {
  testing::Spring spring(omega * omega);
  Stepper stepper(method, kTight);
  if (before != nullptr) stepper.return_to({state_of(*before, omega), before_h});
  State next;
  const StepReport report = stepper.step(spring, state_of(now, omega), h, Vec3::Zero(), {}, next);
  EXPECT_EQ(report.verdict, Verdict::solved) << describe(report.verdict);
  return number_of(next, omega);
}

void expect_damping_and_phase(Complex z, double damping, double phase, double y) {
  EXPECT_NEAR(std::abs(z), damping, kTolerance * damping) << "y = " << y;
  EXPECT_NEAR(-std::arg(z) / y, phase, kTolerance * phase) << "y = " << y;
}

// z of BDF2 with equal steps: the root of (3 + 2iy) z² − 4z + 1 = 0 that approaches 1 as y approaches 0.
Complex principal_root(double y) {
  return (2.0 + std::sqrt(1.0 - 2i * y)) / (3.0 + 2i * y);
}

constexpr Complex kStart{0.6, 0.8};

TEST(Oscillator, ImplicitEulerDampsAndTurnsAsItsExactSolution) {
  for (double y : kProducts) {
    const Complex z = stepped(Method::implicit_euler, y / kStep, kStep, kStart) / kStart;
    expect_damping_and_phase(z, 1 / std::sqrt(1 + y * y), std::atan(y) / y, y);
  }
}

TEST(Oscillator, ImplicitMidpointDampsNothingAndTurnsAsItsExactSolution) {
  for (double y : kProducts) {
    const Complex z = stepped(Method::implicit_midpoint, y / kStep, kStep, kStart) / kStart;
    expect_damping_and_phase(z, 1, 2 * std::atan(y / 2) / y, y);
  }
}

TEST(Oscillator, Bdf2DampsAndTurnsAsThePrincipalRootOfItsCharacteristicPolynomial) {
  for (double y : kProducts) {
    const Complex root = principal_root(y);
    ASSERT_LT(std::abs((3.0 + 2i * y) * root * root - 4.0 * root + 1.0), 1e-13 * (3 + 2 * y));
    // The history consists of two states of the sequence 1, z, z², ...
    const Complex before = kStart, now = root * kStart;
    const Complex z = stepped(Method::bdf2, y / kStep, kStep, now, &before, kStep) / now;
    expect_damping_and_phase(z, std::abs(root), -std::arg(root) / y, y);
  }
}

TEST(Oscillator, FirstStepOfBdf2IsAnEulerStep) {
  for (double y : kProducts)
    EXPECT_EQ(stepped(Method::bdf2, y / kStep, kStep, kStart),
              stepped(Method::implicit_euler, y / kStep, kStep, kStart));
}

TEST(Oscillator, Bdf2AfterARestartIsAnEulerStepAgain) {
  testing::Spring spring(100);
  const State before = state_of(1, 10), now = state_of(1i, 10);
  Stepper stepper(Method::bdf2, kTight);
  stepper.return_to({before, 0.01});
  State with_history, restarted;
  stepper.step(spring, now, 0.01, Vec3::Zero(), {}, with_history);
  stepper.restart();
  stepper.step(spring, now, 0.01, Vec3::Zero(), {}, restarted);
  EXPECT_EQ(number_of(restarted, 10), stepped(Method::implicit_euler, 10, 0.01, 1i));
  EXPECT_GT(std::abs(number_of(with_history, 10) - number_of(restarted, 10)), 1e-3);
}

TEST(Oscillator, Bdf2WithVariableStepsDifferentiatesTheParabolaThroughThreeStates) {
  for (double r : {0.25, 0.5, 1.0, 2.0}) {
    const double omega = 130, h = 0.01, h_before = h / r;
    const Complex before{0.3, -0.7}, now{-0.2, 0.5};
    const Complex next = stepped(Method::bdf2, omega, h, now, &before, h_before);
    // Derivatives at t = h of the Lagrange polynomials through −h_before, 0 and h.
    const double at_before = h / (h_before * (h_before + h));
    const double at_now = -(h + h_before) / (h * h_before);
    const double at_next = 1 / h + 1 / (h + h_before);
    ASSERT_NEAR(at_before + at_now + at_next, 0, 1e-12 / h);
    const Complex expected = -(at_before * before + at_now * now) / (at_next + 1i * omega);
    EXPECT_LT(std::abs(next - expected), 1e-11 * std::abs(expected)) << "r = " << r;
  }
}

TEST(Oscillator, ExactFiguresOfTheThreeMethodsAtATenth) {
  // Values computed by hand from the formulas, to six digits: an independent check of the expressions above.
  EXPECT_NEAR(std::abs(stepped(Method::implicit_euler, 10, kStep, kStart)), 0.995037, 5e-7);
  EXPECT_NEAR(std::abs(stepped(Method::implicit_midpoint, 10, kStep, kStart)), 1.0, 5e-7);
  const Complex before = kStart, now = principal_root(0.1) * kStart;
  EXPECT_NEAR(std::abs(stepped(Method::bdf2, 10, kStep, now, &before, kStep) / now), 0.999976, 5e-7);
}

}  // namespace
}  // namespace weft::integrator
