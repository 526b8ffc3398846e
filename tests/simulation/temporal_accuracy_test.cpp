// Tests the accuracy in time with a swinging sheet: order with fixed steps and with a tolerance, and error estimates.
// Prints tables.
#include <gtest/gtest.h>

#include <cstdio>

#include "simulation/swinging_sheet.hpp"

namespace weft::simulation {
namespace {

using integrator::name_of;
using testing::kIntegrators;
using testing::rms_distance;
using testing::SwingEnd;

int order_of(scene::Integrator integrator) {
  return integrator == scene::Integrator::implicit_euler ? 1 : 2;
}

// A moderately stiff sheet. Its membrane waves have frequencies up to 2 / l √(2k/ρ) = 380 rad/s, with cells of width l.
// All steps resolve the waves that are excited. The free edge falls by 0.4 m in 0.3 s.
class SwingingSheet : public ::testing::Test {
 protected:
  static constexpr int kFrames = 6;  // at 20 frames per second

  static scene::Scene sheet(scene::Integrator integrator) {
    scene::Scene scene = testing::swinging_sheet(7, 100, 20, 1e-3);
    scene.time.fps = 20;
    scene.time.integrator = integrator;
    return scene;
  }
  static SwingEnd swing_with_step(scene::Integrator integrator, double step) {
    scene::Scene scene = sheet(integrator);
    scene.time.step = step;
    // With this tolerance, the error of Newton's method is below 1e-8 m.
    scene.solver.newton_tolerance = 1e-7;
    scene.solver.linear_tolerance = 1e-3;
    return testing::swing(scene, kFrames);
  }
  static SwingEnd swing_with_tolerance(scene::Integrator integrator, double tolerance) {
    scene::Scene scene = sheet(integrator);
    scene.time.tolerance = tolerance;
    return testing::swing(scene, kFrames);
  }
  // A run by the midpoint rule with steps eight times finer than the finest measured ones. Its error is a third of its
  // distance to the run with twice the step.
  static const SwingEnd& reference() {
    static const SwingEnd kEnd = [] {
      const SwingEnd fine = swing_with_step(scene::Integrator::implicit_midpoint, 1.0 / 12800);
      const SwingEnd coarse = swing_with_step(scene::Integrator::implicit_midpoint, 1.0 / 6400);
      const double error = rms_distance(fine.x, coarse.x) / 3;
      std::printf("reference: implicit_midpoint, step 1/12800 s, its own error %.1e m\n", error);
      EXPECT_LT(error, 1e-7);
      return fine;
    }();
    return kEnd;
  }
};

TEST_F(SwingingSheet, ConvergesWithTheOrderOfEachMethodWhereStepsAreFixed) {
  const SwingEnd& exact = reference();
  std::printf("%-18s %8s %10s %6s %10s %10s\n", "", "step s", "error m", "order", "estimate m", "est./error");
  for (scene::Integrator integrator : kIntegrators) {
    double before = 0;
    for (int rate : {200, 400, 800, 1600}) {
      const SwingEnd end = swing_with_step(integrator, 1.0 / rate);
      const double error = rms_distance(end.x, exact.x), order = before > 0 ? std::log2(before / error) : 0;
      std::printf("%-18s   1/%-4d %10.2e %6.2f %10.2e %10.2f\n", name_of(integrator).c_str(), rate, error, order,
                  end.estimate, end.estimate / error);
      // Measured orders: 0.90, 0.93, 0.96 for Euler, whose next error term is a few per cent; 1.99 to 2.03 for the
      // others.
      if (before > 0) {
        EXPECT_NEAR(order, order_of(integrator), integrator == scene::Integrator::implicit_euler ? 0.12 : 0.06);
      }
      // Measured: the estimate, which is the sum of the sizes of the local errors, is 1.2 to 2.1 times the error at the
      // end. The sheet makes only half a swing, in which local errors hardly cancel.
      EXPECT_GT(end.estimate, error);
      EXPECT_LT(end.estimate, 3 * error);
      before = error;
    }
  }
}

TEST_F(SwingingSheet, KeepsTheSecondOrderInAir) {
  const auto end = [](scene::Integrator integrator, int rate) {
    scene::Scene scene = sheet(integrator);
    scene.physics.air_density = 1.2;
    scene.time.step = 1.0 / rate;
    scene.solver.newton_tolerance = 1e-7;
    scene.solver.linear_tolerance = 1e-3;
    return testing::swing(scene, kFrames).x;
  };
  const auto exact = end(scene::Integrator::implicit_midpoint, 6400);
  for (scene::Integrator integrator : {scene::Integrator::implicit_midpoint, scene::Integrator::bdf2}) {
    const double coarse = rms_distance(end(integrator, 400), exact), fine = rms_distance(end(integrator, 800), exact);
    std::printf("%-18s in air, step 1/800: error %.2e m, order %.2f\n", name_of(integrator).c_str(), fine,
                std::log2(coarse / fine));
    // Measured order: 2.01 and 2.00. If the drag were a mean over the step, the order would be 1.1, and the error 9 to
    // 34 times as large.
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << name_of(integrator);
  }
}

TEST_F(SwingingSheet, ErrorFollowsTheToleranceWithTheExponentOfEachMethod) {
  const SwingEnd& exact = reference();
  std::printf("%-18s %11s %6s %8s %10s %8s %10s\n", "", "tolerance m", "steps", "rejected", "error m", "exponent",
              "est./error");
  for (scene::Integrator integrator : kIntegrators) {
    const double exponent = order_of(integrator) / (1.0 + order_of(integrator));
    double before = 0, first = 0;
    for (double tolerance : {1.6e-5, 8e-6, 4e-6, 2e-6, 1e-6, 5e-7, 2.5e-7}) {
      const SwingEnd end = swing_with_tolerance(integrator, tolerance);
      const double error = rms_distance(end.x, exact.x);
      std::printf("%-18s %11.2e %6d %8d %10.2e %8.2f %10.2f\n", name_of(integrator).c_str(), tolerance, end.steps,
                  end.rejected, error, before > 0 ? std::log2(before / error) : 0, end.estimate / error);
      // The controller does not change a step length by less than a tenth, so that errors may deviate by a fifth.
      // Therefore, each halving of the tolerance must only reduce the error.
      if (before > 0) {
        EXPECT_LT(error, before);
      } else {
        first = error;
      }
      EXPECT_LT(end.rejected, 0.1 * end.steps);
      EXPECT_GT(end.estimate, error / 1.5);
      EXPECT_LT(end.estimate, 3 * error);
      before = error;
    }
    // Exponent over all six halvings of the tolerance.
    const double measured = std::log(first / before) / std::log(64.0);
    std::printf("%-18s exponent %.3f, expected %.3f\n", name_of(integrator).c_str(), measured, exponent);
    EXPECT_NEAR(measured, exponent, 0.05);
  }
}

TEST_F(SwingingSheet, TheNewtonResidualHardlyChangesTheErrorAtATolerance) {
  const SwingEnd& exact = reference();
  for (scene::Integrator integrator : kIntegrators) {
    for (double tolerance : {1e-4, 1e-6}) {
      scene::Scene scene = sheet(integrator);
      scene.time.tolerance = tolerance;
      const double error = rms_distance(testing::swing(scene, kFrames).x, exact.x);
      scene.solver.newton_tolerance = 1e-7;
      const double solved = rms_distance(testing::swing(scene, kFrames).x, exact.x);
      // Measured difference: below 1 %.
      EXPECT_NEAR(error, solved, 0.03 * solved) << name_of(integrator) << " at " << tolerance;
    }
  }
}

}  // namespace
}  // namespace weft::simulation
