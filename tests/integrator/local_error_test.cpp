// Tests of the estimate of the local error, of the step lengths that follow from it, and of the growth of BDF2 steps.
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "integrator/small_systems.hpp"
#include "physics/integrator/step_control.hpp"

namespace weft::integrator {
namespace {

using testing::kMethods;

// Newton tolerance: above the rounding error of x / h², and far below the errors of the methods.
constexpr NewtonParameters kAboveRounding{.tolerance = 1e-9, .max_iterations = 40, .linear_tolerance = 1e-12};

// State of the hardening spring after a time t [s]. The error of x is below 1e-14 m.
State moved(const State& now, double t) {
  return testing::moved(now, t, 200);
}

struct Errors {
  double estimated, made;
};

// Estimated and actual error [m] of one step over h from a state of the exact motion. `r`: ratio of h to the length of
// the step before it, which is exact; 0: no step before it.
Errors errors_of_one_step(Method method, double h, double r) {
  testing::HardeningSpring spring;
  const State now{{Vec3(1, 0.2, -0.3)}, {Vec3(0.1, 0.8, 0.4)}};
  Stepper stepper(method, kAboveRounding);
  if (r > 0) stepper.return_to({moved(now, -h / r), h / r});
  State next;
  const StepReport report = stepper.step(spring, now, h, Vec3::Zero(), {}, next);
  EXPECT_EQ(report.verdict, Verdict::solved);
  return {report.local_error, (next.x[0] - moved(now, h).x[0]).norm()};
}

TEST(LocalError, OfOneStepIsEstimatedUpToTermsOfTheNextOrder) {
  // Tolerance, 10 h: the estimate lacks the next term of the error, which is of the order of h times the first one.
  for (Method method : kMethods) {
    for (double r : {0.5, 1.0, 1.9}) {
      // The error of one BDF2 step grows by half in the following steps; the estimate includes this growth.
      const double whole = method == Method::bdf2 ? 1.5 : 1;
      for (double h : {0.02, 0.01, 0.005}) {
        const Errors errors = errors_of_one_step(method, h, r);
        const double off = std::abs(errors.estimated / (whole * errors.made) - 1);
        EXPECT_LT(off, 10 * h) << "method " << static_cast<int>(method) << ", r = " << r << ", h = " << h;
      }
    }
  }
}

TEST(LocalError, WithoutAHistoryIsThatOfEuler) {
  const double h = 0.005;
  const Errors euler = errors_of_one_step(Method::implicit_euler, h, 0);
  const Errors bdf2 = errors_of_one_step(Method::bdf2, h, 0);
  const Errors midpoint = errors_of_one_step(Method::implicit_midpoint, h, 0);
  EXPECT_NEAR(euler.estimated, euler.made, 0.05 * euler.made);
  EXPECT_NEAR(bdf2.estimated, 1.5 * bdf2.made, 0.05 * bdf2.made);
  EXPECT_EQ(bdf2.made, euler.made);
  // For the midpoint rule, the estimate is only an upper bound, because the rule has no error of this order.
  EXPECT_GT(midpoint.estimated, 100 * midpoint.made);
}

TEST(LocalError, IsThatOfTheWorstPartAndMeasuredByMass) {
  // In free fall, Euler's method moves every free particle too far by `ahead` = ½ g h².
  testing::Spring nothing(0, {1, 3, 2});
  nothing.linear_system().blocks = {{0, 2}, {2, 3}};
  const Vec3 g(0, 0, -10);
  const double h = 0.1, ahead = 0.5 * h * h * 10;
  const State now{std::vector<Vec3>(3, Vec3::Zero()), std::vector<Vec3>(3, Vec3::Zero())};
  State next;
  const auto error_with = [&](std::vector<Index> held_particles) {
    std::vector<HeldParticle> held;
    for (Index p : held_particles) held.push_back({{p, Mat3::Zero()}, Vec3::Zero(), Vec3::Zero()});
    Stepper stepper(Method::implicit_euler, kAboveRounding);
    return stepper.step(nothing, now, h, g, held, next).local_error;
  };
  EXPECT_NEAR(error_with({}), ahead, 1e-12);
  EXPECT_NEAR(error_with({1, 2}), std::sqrt(1.0 / 4) * ahead, 1e-12);
  EXPECT_NEAR(error_with({0, 2}), std::sqrt(3.0 / 4) * ahead, 1e-12);
  EXPECT_NEAR(error_with({0, 1}), ahead, 1e-12);
  EXPECT_EQ(error_with({0, 1, 2}), 0);
}

// Lengths of the accepted steps [s], up to the time `end`, if a step of length h from time t has the error error(t, h).
std::vector<double> lengths(Method method, double tolerance, const std::function<double(double t, double h)>& error,
                            double end) {
  StepControl control(method, tolerance, 1e-3);
  std::vector<double> accepted;
  double t = 0;
  while (t < end) {
    const double h = control.next_step_size(), e = error(t, h);
    if (!control.accepts(h, e)) {
      control.record_rejected_step(h, e);
      continue;
    }
    control.record_accepted_step(h, e);
    accepted.push_back(h);
    t += h;
  }
  return accepted;
}

TEST(StepControl, BringsTheErrorOfSmoothMotionJustBelowTheTolerance) {
  for (Method method : kMethods) {
    const int power = method == Method::implicit_euler ? 2 : 3;
    const auto error = [&](double, double h) { return 5 * std::pow(h, power); };
    for (double tolerance : {1e-3, 1e-6}) {
      const double h = lengths(method, tolerance, error, 3).back();
      EXPECT_LE(error(0, h), tolerance);
      // The target is 0.7 of the tolerance. The controller does not change a length by less than a tenth.
      EXPECT_GT(error(0, h), 0.7 / std::pow(1.1, power) * tolerance);
    }
  }
}

TEST(StepControl, NeverLetsAStepGrowByMoreThanBdf2Bears) {
  // The error of a step over h jumps between 50 h³ and 0.05 h³.
  const auto error = [](double t, double h) { return (std::fmod(t, 0.4) < 0.2 ? 50 : 0.05) * h * h * h; };
  const std::vector<double> steps = lengths(Method::bdf2, 1e-5, error, 5);
  double largest = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) largest = std::max(largest, steps[i] / steps[i - 1]);
  EXPECT_LE(largest, Stepper::kMaxStepRatio);
  EXPECT_GT(largest, 1.3);
}

TEST(StepControl, PassesAJumpOfVelocityInABoundedNumberOfSteps) {
  // The step that contains t = 0.5 has the error of a velocity jump of 10 m/s. Only steps up to 5e-5 s meet the
  // tolerance there. A try is at least a fifth as long as the rejected try before it; a step is at most 1.5 times as
  // long as the accepted step before it. This takes 5 tries down and 17 steps up.
  int tries = 0;
  const auto error = [&](double t, double h) {
    ++tries;
    return 5 * h * h + (t <= 0.5 && t + h > 0.5 ? 10 * h : 0);
  };
  lengths(Method::implicit_euler, 5e-4, error, 1);
  EXPECT_LT(tries, 200);
  // If no step meets the tolerance, a step of the minimum length is accepted.
  const auto wall = [&](double t, double h) { return t <= 0.5 && t + h > 0.5 ? 1 : 5 * h * h; };
  EXPECT_DOUBLE_EQ(std::ranges::min(lengths(Method::implicit_euler, 5e-4, wall, 1)), numerics.steps.min_step);
}

TEST(StepControl, DoesNotGrowAtOnceAfterAStepWasDoneAgain) {
  StepControl control(Method::bdf2, 1e-4, 0.01);
  control.record_unsolved_step(0.01);
  EXPECT_DOUBLE_EQ(control.next_step_size(), 0.005);
  control.record_accepted_step(0.005, 1e-9);
  EXPECT_DOUBLE_EQ(control.next_step_size(), 0.005);
  control.record_accepted_step(0.005, 1e-9);
  EXPECT_DOUBLE_EQ(control.next_step_size(), 0.0075);
}

TEST(Bdf2Ratio, LongestStepFollowsTheLastOne) {
  Stepper bdf2(Method::bdf2, kAboveRounding), euler(Method::implicit_euler, kAboveRounding);
  EXPECT_EQ(bdf2.longest_step(), std::numeric_limits<double>::infinity());
  for (Stepper* stepper : {&bdf2, &euler}) stepper->return_to({{{Vec3::Zero()}, {Vec3::Zero()}}, 0.01});
  EXPECT_DOUBLE_EQ(bdf2.longest_step(), 0.02);
  EXPECT_EQ(euler.longest_step(), std::numeric_limits<double>::infinity());
  bdf2.restart();
  EXPECT_EQ(bdf2.longest_step(), std::numeric_limits<double>::infinity());
}

// The step loop uses BDF2 in place of the midpoint rule while contacts act. A resumed run must limit its next step like
// the run that was not interrupted.
TEST(Bdf2Ratio, SavedHistoryBoundsTheNextStepOfAnotherMethod) {
  Stepper saved(Method::implicit_midpoint, kAboveRounding), restored(Method::implicit_midpoint, kAboveRounding);
  saved.set_method(Method::bdf2);
  saved.return_to({{{Vec3::Zero()}, {Vec3::Zero()}}, 0.01});
  ByteWriter writer;
  saved.serialize(writer, 1);
  ByteReader reader{writer.bytes};
  restored.serialize(reader, 1);
  EXPECT_DOUBLE_EQ(restored.longest_step(), 0.02);
  EXPECT_TRUE(reader.bytes.empty());
}

// Difference of the last two positions of a run of BDF2, relative to the error kOff [m] of its first history: by the
// formula of BDF2, and by the Stepper. Each step is r times as long as the one before, from y = ω h = 1e-4 to 1e-2.
struct Growth {
  double formula, stepper;
  int steps;
};
Growth change_while_growing(double r) {
  constexpr double kOmega = 1e4, kOff = 0.1;
  testing::Spring spring(kOmega * kOmega);
  // Newton tolerance, 1e-6: the unknown x − x̂ = −β² ω² x is about 1e-8 x, so rounding of x leaves six digits of it.
  Stepper stepper(Method::bdf2, {.tolerance = 1e-6, .max_iterations = 40, .linear_tolerance = 1e-12});
  double h = 1e-4 / kOmega, before = 1 + kOff, now = 1, v_before = 0, v_now = 0;
  stepper.return_to({{{Vec3(before, 0, 0)}, {Vec3::Zero()}}, h});
  State state{{Vec3(now, 0, 0)}, {Vec3::Zero()}}, next;
  int steps = 0;
  while (h * kOmega < 1e-2) {
    h *= r;
    const double a = (1 + r) * (1 + r) / (1 + 2 * r), b = r * r / (1 + 2 * r), beta = h * (1 + r) / (1 + 2 * r);
    const double x_hat = a * now - b * before, v_hat = a * v_now - b * v_before;
    const double x = (x_hat + beta * v_hat) / (1 + beta * beta * kOmega * kOmega);
    before = std::exchange(now, x);
    v_before = std::exchange(v_now, (x - x_hat) / beta);
    EXPECT_EQ(stepper.step(spring, state, h, Vec3::Zero(), {}, next).verdict, Verdict::solved);
    stepper.accept(state, next, h);
    std::swap(state, next);
    ++steps;
  }
  return {(before - now) / kOff, (next.x[0].x() - state.x[0].x()) / kOff, steps};
}

TEST(Bdf2Ratio, UpToTheBoundErrorsOfTheHistoryFadeAndBeyondTheyGrow) {
  for (double r : {1.5, Stepper::kMaxStepRatio, 1 + std::sqrt(2.0), 3.0}) {
    const Growth growth = change_while_growing(r);
    // Each step multiplies the difference by r² / (1 + 2r). The oscillation changes it by at most y² / 2.
    const double expected = std::pow(r * r / (1 + 2 * r), growth.steps);
    EXPECT_NEAR(growth.formula, expected, 0.01) << "r = " << r;
    if (r <= Stepper::kMaxStepRatio) {
      EXPECT_NEAR(growth.stepper, growth.formula, 1e-4) << "r = " << r;
    }
  }
  EXPECT_LT(change_while_growing(Stepper::kMaxStepRatio).formula, 0.25);
  EXPECT_GT(change_while_growing(3).formula, 3);
}

TEST(Bdf2Ratio, AStepTooLongForTheLastOneIsOneOfEuler) {
  testing::Spring spring(1);
  const State before{{Vec3(1, 0, 0)}, {Vec3::Zero()}}, now{{Vec3(0.9, 0, 0)}, {Vec3(-1, 0, 0)}};
  State next, euler_next;
  for (const double ratio : {0.999, 1.001}) {
    const double h = ratio * Stepper::kMaxStepRatio * 0.1;
    Stepper bdf2(Method::bdf2, kAboveRounding), euler(Method::implicit_euler, kAboveRounding);
    bdf2.return_to({before, 0.1});
    ASSERT_EQ(bdf2.step(spring, now, h, Vec3::Zero(), {}, next).verdict, Verdict::solved);
    ASSERT_EQ(euler.step(spring, now, h, Vec3::Zero(), {}, euler_next).verdict, Verdict::solved);
    const double apart = (next.x[0] - euler_next.x[0]).norm();
    EXPECT_TRUE(ratio < 1 ? apart > 0.01 : apart < 1e-9) << ratio << ": " << apart;
  }
}

TEST(Bdf2Ratio, StiffOscillatorDecaysWhateverTheStepsWithinTheBound) {
  // y = ω h doubles in seven steps from 1 to 128, then starts again from 1.
  constexpr double kOmega = 1e3;
  testing::Spring spring(kOmega * kOmega);
  Stepper stepper(Method::bdf2, kAboveRounding);
  State now{{Vec3(1, 0, 0)}, {Vec3::Zero()}}, next;
  double size = 1;
  for (int s = 0; s < 160; ++s) {
    const double h = std::ldexp(1 / kOmega, s % 8);
    ASSERT_EQ(stepper.step(spring, now, h, Vec3::Zero(), {}, next).verdict, Verdict::solved);
    stepper.accept(now, next, h);
    std::swap(now, next);
    size = std::hypot(now.x[0].x(), now.v[0].x() / kOmega);
    ASSERT_LT(size, 1.5) << "step " << s;
  }
  EXPECT_LT(size, 1e-6);
}

}  // namespace
}  // namespace weft::integrator
