// Tests of Stepper: free fall, held particles, impacts, and reports.
#include "physics/integrator/stepper.hpp"

#include <gtest/gtest.h>

#include "core/numerics.hpp"
#include "core/timer.hpp"
#include "integrator/small_systems.hpp"

namespace weft::integrator {
namespace {

using testing::kMethods;
using testing::kTight;
using testing::Spring;

TEST(Stepper, FreeFallFollowsTheLawOfEachMethod) {
  const Vec3 g(0.5, 0, -9.81), x0(1, 2, 3), v0(0.3, 0, 1);
  const double h = 0.02;
  Spring nothing(0, {1, 0.003});
  for (Method method : kMethods) {
    Stepper stepper(method, kTight);
    State now{{x0, x0}, {v0, v0}}, next;
    for (int n = 1; n <= 25; ++n) {
      ASSERT_EQ(stepper.step(nothing, now, h, g, {}, next).verdict, Verdict::solved);
      stepper.accept(now, next, h);
      std::swap(now, next);
      const double t = n * h;
      // Errors: Euler's method falls too far by ½ g h t. BDF2 keeps an error from its first step, which is an Euler
      // step.
      Vec3 expected = x0 + t * v0 + 0.5 * t * t * g;
      if (method == Method::implicit_euler) expected += 0.5 * h * t * g;
      if (method == Method::bdf2) expected += 0.75 * h * h * (1 - std::pow(3, -n)) * g;
      for (std::size_t i : {0u, 1u}) {
        // Tolerances [m], [m/s]: a few rounding errors in each step.
        EXPECT_LT((now.x[i] - expected).norm(), 1e-13 * n);
        EXPECT_LT((now.v[i] - (v0 + t * g)).norm(), 1e-12 * n);
      }
    }
  }
}

TEST(Stepper, HeldParticleEndsExactlyAtItsTarget) {
  Spring spring(50, {1, 2});
  for (Method method : kMethods) {
    Stepper stepper(method, kTight);
    const State now{{Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0, 3, 0), Vec3(1, 1, 1)}};
    const HeldParticle held{{1, Mat3::Zero()}, Vec3(0.1, 1.3, -0.7), Vec3(7, 8, 9)};
    State next, alone;
    ASSERT_EQ(stepper.step(spring, now, 0.01, Vec3(0, 0, -9.81), {&held, 1}, next).verdict, Verdict::solved);
    EXPECT_EQ(next.x[1], held.x_end);
    EXPECT_EQ(next.v[1], held.v_end);
    // The other particle moves as if no particle were held.
    ASSERT_EQ(stepper.step(spring, now, 0.01, Vec3(0, 0, -9.81), {}, alone).verdict, Verdict::solved);
    EXPECT_LT((next.x[0] - alone.x[0]).norm(), 1e-14);
    EXPECT_GT((next.x[1] - alone.x[1]).norm(), 0.1);
  }
}

TEST(Stepper, ParticleHeldInAPlaneIsFreeWithinIt) {
  Spring spring(50, {1});
  const Vec3 n = Vec3(1, 2, 2) / 3;
  const Mat3 free = Mat3::Identity() - n * n.transpose();
  for (Method method : kMethods) {
    Stepper stepper(method, kTight);
    const State now{{Vec3(1, 0, 0)}, {Vec3(0, 3, 0)}};
    const HeldParticle held{{0, free}, Vec3(0.9, 0, 0.1), Vec3(2, 0, 0)};
    State next, alone;
    ASSERT_EQ(stepper.step(spring, now, 0.01, Vec3(0, 0, -9.81), {&held, 1}, next).verdict, Verdict::solved);
    ASSERT_EQ(stepper.step(spring, now, 0.01, Vec3(0, 0, -9.81), {}, alone).verdict, Verdict::solved);
    // Along n, the particle moves as prescribed; across n, as if it were free, because the spring is isotropic.
    EXPECT_NEAR(n.dot(next.x[0] - held.x_end), 0, 1e-15);
    EXPECT_NEAR(n.dot(next.v[0] - held.v_end), 0, 1e-14);
    EXPECT_LT((free * (next.x[0] - alone.x[0])).norm(), 1e-13);
    EXPECT_LT((free * (next.v[0] - alone.v[0])).norm(), 1e-11);
  }
}

TEST(Stepper, StepIsRememberedOnlyWhenAccepted) {
  Spring spring(400);
  for (Method method : kMethods) {
    Stepper stepper(method, kTight);
    const State before{{Vec3(1, 0, 0)}, {Vec3(0, 1, 0)}}, now{{Vec3(0.9, 0, 0)}, {Vec3(-0.1, 1, 0)}};
    stepper.return_to({before, 0.01});
    State first, other, again;
    stepper.step(spring, now, 0.01, Vec3::Zero(), {}, first);
    stepper.step(spring, before, 0.03, Vec3(1, 1, 1), {}, other);
    stepper.step(spring, now, 0.01, Vec3::Zero(), {}, again);
    EXPECT_EQ(first.x, again.x);
    EXPECT_EQ(first.v, again.v);
  }
}

TEST(Stepper, LeavesAFractionOfTheLocalErrorAndReportsIt) {
  // `exact` is the end of the step of Euler's method, solved to rounding accuracy.
  testing::HardeningSpring spring;
  const double h = 0.5;
  const State now{{Vec3(3, 0, 0)}, {Vec3(0, 2, 0)}};
  State exact;
  ASSERT_EQ(Stepper(Method::implicit_euler, kTight).step(spring, now, h, Vec3::Zero(), {}, exact).verdict,
            Verdict::solved);
  for (double tolerance : {0.3, 1e-3, 1e-8}) {
    Stepper stepper(Method::implicit_euler, {tolerance, 40, 0.1, 1000});
    State next;
    const StepReport report = stepper.step(spring, now, h, Vec3::Zero(), {}, next);
    ASSERT_EQ(report.verdict, Verdict::solved);
    EXPECT_LE(report.remaining_error, report.allowed);
    // The actual velocity error is at most three times the allowed one.
    EXPECT_LT((next.v[0] - exact.v[0]).norm(), 3 * report.allowed) << tolerance;
    EXPECT_LE(report.solver_error, tolerance * report.local_error);
  }
}

TEST(Stepper, AllowsInvisibleResidualsUnlessAToleranceIsGiven) {
  // The particle starts 1e-6 m from its rest position. This motion is below the visibility threshold.
  testing::HardeningSpring spring;
  const State now{{Vec3(1e-6, 0, 0)}, {Vec3::Zero()}};
  State next;
  Stepper stepper(Method::implicit_euler, {0.3, 40, 0.1, 1000});
  EXPECT_GT(stepper.step(spring, now, 0.01, Vec3::Zero(), {}, next).allowed, 1e-5);
  Stepper strict(Method::implicit_euler, {0.3, 40, 0.1, 1000, 1e-9});
  EXPECT_LT(strict.step(spring, now, 0.01, Vec3::Zero(), {}, next).allowed, 1e-8);
}

/// A spring whose matrix is about a hundred times too stiff: each Newton iteration reduces the error by 4 %.
class Sluggish final : public Spring {
 public:
  Sluggish() : Spring(1) {}

 protected:
  Mat3 stiffness_of(const Vec3&) const override { return 1e6 * Mat3::Identity(); }
};

// From Numerics::Newton::slow_after iterations on, larger velocity errors are allowed, up to the visibility threshold.
// NewtonParameters::position_tolerance lowers this threshold, and NewtonParameters::tolerance multiplies it.
TEST(Stepper, BoundsTheErrorOfASlowSolveByTheGivenTolerance) {
  Sluggish system;
  const State now{{Vec3::Zero()}, {Vec3::Zero()}};
  State next;
  const double tolerance = 0.01, of_positions = 1e-6;
  Stepper stepper(Method::implicit_euler, {tolerance, 1000, 1e-12, 1000, of_positions});
  const StepReport report = stepper.step(system, now, 0.01, Vec3(0, 0, -0.02), {}, next);
  ASSERT_EQ(report.verdict, Verdict::solved);
  EXPECT_GT(report.newton_iterations, 20);
  // Computed by hand: the error is 1.0e-8 m after 84 iterations; without the factor `tolerance`, 1.3e-7 m after 20.
  EXPECT_LE(report.solver_error, 1.001 * tolerance * std::max(of_positions, report.local_error));
}

// Two uncoupled springs, each a diagonal block. Records the positions at which Newton's method linearises them.
class TwoParts : public testing::HardeningSpring {
 public:
  TwoParts() : HardeningSpring({1, 1}) { linear_system().blocks = {{0, 1}, {1, 2}}; }
  void linearise(const StagePoint& at, int iteration, std::span<Vec3> force) override {
    evaluated_at.emplace_back(at.x.begin(), at.x.end());
    for (solver::DiagonalBlock& part : linear_system().blocks) ++part.version;
    HardeningSpring::linearise(at, iteration, force);
  }
  std::vector<std::vector<Vec3>> evaluated_at;
};

TEST(Stepper, PartThatIsSolvedStandsStillWhileAnotherGoesOn) {
  TwoParts system;
  const State now{{Vec3(0.1, 0, 0), Vec3(3, 0, 0)}, {Vec3(0, 0.1, 0), Vec3(0, 2, 0)}};
  State next;
  Stepper stepper(Method::implicit_euler, {1e-3, 40, 1e-6, 1000});
  ASSERT_EQ(stepper.step(system, now, 0.5, Vec3::Zero(), {}, next).verdict, Verdict::solved);
  ASSERT_GE(system.evaluated_at.size(), 4U);
  const std::vector<Vec3>& before_last = *(system.evaluated_at.end() - 2);
  EXPECT_EQ(next.x[0], before_last[0]);
  EXPECT_NE(next.x[1], before_last[1]);
}

// A system whose force is not a number.
class Broken : public testing::HardeningSpring {
 protected:
  Vec3 force_on(const Vec3&) const override { return Vec3::Constant(std::numeric_limits<double>::quiet_NaN()); }
};

Verdict verdict_of(System&& system, std::size_t particles, const NewtonParameters& parameters) {
  Stepper stepper(Method::implicit_euler, parameters);
  const State now{std::vector<Vec3>(particles, Vec3(3, 0, 0)), std::vector<Vec3>(particles, Vec3(0, 2, 0))};
  State next;
  return stepper.step(system, now, 0.5, Vec3::Zero(), {}, next).verdict;
}

TEST(Stepper, SaysWhyAStepIsNotSolved) {
  EXPECT_EQ(verdict_of(testing::HardeningSpring(), 1, kTight), Verdict::solved);
  EXPECT_EQ(verdict_of(Broken(), 1, kTight), Verdict::not_finite);
  NewtonParameters one = kTight;
  one.max_iterations = 1;
  EXPECT_EQ(verdict_of(testing::HardeningSpring(), 1, one), Verdict::newton_stalled);
  EXPECT_EQ(verdict_of(Spring(40), 1, one), Verdict::solved);  // linear: one iteration is enough
}

TEST(Stepper, ReturnsUnfinishedAfterTheGivenIterationsAndContinuesFromThere) {
  testing::HardeningSpring spring;
  const State now{{{2, 0, 0}}, {{0, 3, 0}}};
  for (Method method : kMethods) {
    Stepper stepper(method, kTight);
    State whole = now, continued = now;
    const StepReport at_once = stepper.step(spring, now, 1, Vec3::Zero(), {}, whole);
    ASSERT_EQ(at_once.verdict, Verdict::solved);
    ASSERT_GT(at_once.newton_iterations, 3);
    const auto start = Stepper::Start::unchanged_velocity;
    const StepReport first = stepper.step(spring, now, 1, Vec3::Zero(), {}, continued, start, 2);
    EXPECT_EQ(first.verdict, Verdict::unfinished);
    EXPECT_EQ(first.newton_iterations, 2);
    EXPECT_GT((continued.x[0] - whole.x[0]).norm(), 1e-9);
    const StepReport rest = stepper.step(spring, now, 1, Vec3::Zero(), {}, continued, Stepper::Start::next);
    EXPECT_EQ(rest.verdict, Verdict::solved);
    EXPECT_EQ(rest.newton_iterations, at_once.newton_iterations - 2);
    EXPECT_LT((continued.x[0] - whole.x[0]).norm(), 1e-12);
    // If the last iteration before the pause solves the step, the step counts as solved.
    EXPECT_EQ(stepper.step(spring, now, 1, Vec3::Zero(), {}, continued, start, at_once.newton_iterations).verdict,
              Verdict::solved);
  }
}

/// Records the argument `iteration` of each linearisation.
class CountedSpring final : public testing::HardeningSpring {
 public:
  void linearise(const StagePoint& at, int iteration, std::span<Vec3> force) override {
    iterations.push_back(iteration);
    HardeningSpring::linearise(at, iteration, force);
  }
  std::vector<int> iterations;
};

TEST(Stepper, DoesNotContinueAStepThatItHasReturnedFromOrDiscarded) {
  const State now{{{2, 0, 0}}, {{0, 3, 0}}};
  for (const bool is_discarded : {false, true}) {
    CountedSpring spring;
    Stepper stepper(Method::implicit_euler, kTight);
    State next = now;
    const auto start = Stepper::Start::unchanged_velocity;
    ASSERT_EQ(stepper.step(spring, now, 1, Vec3::Zero(), {}, next, start, 2).verdict, Verdict::unfinished);
    is_discarded ? stepper.discard_unfinished_step() : stepper.return_to(stepper.history());
    spring.iterations.clear();
    stepper.step(spring, now, 1, Vec3::Zero(), {}, next, Stepper::Start::next);
    EXPECT_EQ(spring.iterations.front(), 0);
  }
}

TEST(Stepper, CountsTheIterationsOfTheCallThatPausedButNoEarlierOnes) {
  const State now{{{2, 0, 0}}, {{0, 3, 0}}};
  CountedSpring spring;
  Stepper stepper(Method::implicit_euler, kTight);
  State next = now;
  for (const int expected : {0, 1, 1}) {
    spring.iterations.clear();
    const auto start = expected == 0 ? Stepper::Start::unchanged_velocity : Stepper::Start::next;
    ASSERT_EQ(stepper.step(spring, now, 1, Vec3::Zero(), {}, next, start, 1).verdict, Verdict::unfinished);
    EXPECT_EQ(spring.iterations, std::vector<int>{expected});
  }
}

/// A system that takes 5 ms to find that there is no impact.
class SlowImpacts final : public Spring {
 public:
  using Spring::Spring;
  bool find_impacts(const StagePoint&, const StepStart&, std::span<Vec3>) override {
    const WallTimer timer;
    while (timer.seconds() < 0.005) {
    }
    return false;
  }
};

TEST(Stepper, CountsTheTimeOfImpacts) {
  SlowImpacts spring(40);
  Stepper stepper(Method::bdf2, kTight);
  const State now{{{1, 0, 0}}, {{0, 0, 0}}};
  State next = now;
  EXPECT_GE(stepper.step(spring, now, 0.1, Vec3::Zero(), {}, next).times.forces.wall_s, 0.005);
}

TEST(Stepper, MatrixThatIsNotDefiniteIsReported) {
  // For h = 0.5 s, the rate is 2/s and the diagonal 4 (see Saddle). The matrix is definite for s = 3, but not for
  // s = 400.
  Stepper stepper(Method::implicit_euler, kTight);
  for (const auto& [s, verdict] : {std::pair{3.0, Verdict::solved}, std::pair{400.0, Verdict::indefinite}}) {
    State next;
    const State now{{Vec3(1, 0, 0), Vec3(-1, 0, 0)}, {Vec3::Zero(), Vec3::Zero()}};
    testing::Saddle saddle(s);
    EXPECT_EQ(stepper.step(saddle, now, 0.5, Vec3::Zero(), {}, next).verdict, verdict);
  }
}

/// A Saddle with an impact on particle 0 in each step. In the linear system of impacts, `coupling` is added to s.
class StruckSaddle final : public testing::Saddle {
 public:
  explicit StruckSaddle(double coupling) : Saddle(3), coupling_(coupling) {}
  bool find_impacts(const StagePoint&, const StepStart&, std::span<Vec3> right_side) override {
    right_side[0] = Vec3(1, 0, 0);
    solver::BlockMatrix& matrix = linear_system().matrix;
    for (Index i : {0, 1}) matrix.add_scalar(matrix.slot(i, 1 - i), coupling_);
    return true;
  }

 private:
  double coupling_;
};

TEST(Stepper, LinearSolveOfImpactsIsCountedAndJudged) {
  const double h = 0.5;  // the diagonal of the matrix is 9 (see Saddle)
  const State now{{Vec3(1, 0, 0), Vec3(-1, 0, 0)}, {Vec3::Zero(), Vec3::Zero()}};
  const auto report_of = [&](System&& system, int max_linear_iterations) {
    NewtonParameters parameters = kTight;
    parameters.max_linear_iterations = max_linear_iterations;
    Stepper stepper(Method::bdf2, parameters);
    stepper.return_to({now, h});
    State next;
    return stepper.step(system, now, h, Vec3::Zero(), {}, next);
  };
  const StepReport calm = report_of(testing::Saddle(3), 1000), struck = report_of(StruckSaddle(0), 1000);
  EXPECT_EQ(struck.verdict, Verdict::solved);
  EXPECT_EQ(struck.newton_iterations, calm.newton_iterations);
  EXPECT_GT(struck.linear_iterations, calm.linear_iterations);
  EXPECT_LT(struck.solver_error, 1e-9 * numerics.newton.error_duration);
  // One linear iteration solves the systems of Newton's method, whose solutions are antisymmetric, but leaves an error
  // of 0.04 m/s (computed by hand) in that of the impact.
  const StepReport rough = report_of(StruckSaddle(0), 1);
  EXPECT_EQ(rough.verdict, Verdict::solved);
  EXPECT_GT(rough.solver_error, 0.01 * numerics.newton.error_duration);
  EXPECT_EQ(report_of(StruckSaddle(397), 1000).verdict, Verdict::indefinite);
}

TEST(Stepper, VerdictsAreDescribedInDifferentWords) {
  EXPECT_EQ(describe(Verdict::solved), "solved");
  EXPECT_NE(describe(Verdict::not_finite).find("not finite"), std::string_view::npos);
  EXPECT_NE(describe(Verdict::newton_stalled).find("tolerance"), std::string_view::npos);
  EXPECT_NE(describe(Verdict::indefinite).find("not positive definite"), std::string_view::npos);
}

}  // namespace
}  // namespace weft::integrator
