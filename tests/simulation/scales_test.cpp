// Tests a scene at the scale of a doll, a person and a circus tent: steps, iterations and strain must hardly depend on
// the scale.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

struct Scale {
  double size;          // of the sheet [m]
  bool is_time_scaled;  // steps and frames are proportional to the time of fall; else 10 and 40 ms
  int frames;
};

std::ostream& operator<<(std::ostream& out, const Scale& scale) {
  return out << scale.size << (scale.is_time_scaled ? " m, time scaled" : " m");
}

// A sheet of canvas falls on a ball, whose radius is a fifth of the size of the sheet.
std::string tarpaulin(const Scale& scale) {
  const double l = scale.size, time = scale.is_time_scaled ? std::sqrt(l) : 1;
  const auto text = [](double value) { return std::to_string(value); };
  return "[time]\nduration = " + text(scale.frames * time / 25) + "\nfps = " + text(25 / time) +
         "\nstep = " + text(0.01 * time) + "\n[[cloth]]\nname = 'sheet'\nsize = [" + text(l) + ", " + text(l) +
         "]\nparticles = [31, 31]\nposition = [0, 0, " + text(0.43 * l) +
         "]\nmaterial = { fabric = 'canvas' }\n[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nradius = " +
         text(0.2 * l) + "\nposition = [0, 0, " + text(0.225 * l) +
         "]\n[[obstacle]]\nname = 'floor'\nshape = 'plane'\nsize = " + text(5 * l) + "\n";
}

class Tarpaulin : public ::testing::TestWithParam<Scale> {};

TEST_P(Tarpaulin, DrapesWithFewIterationsAndLittleStrain) {
  const scene::Scene scene = support::scene_of_text(tarpaulin(GetParam()));
  int steps = 0, tried = 0, iterations = 0;
  for (const support::MeasuredFrame& frame : support::run_scene(scene)) {
    EXPECT_EQ(frame.pairs, 0u) << "frame " << frame.report.frame;
    // The stretch limit of canvas is 0.078. Measured: up to 0.089 at 40 m, where one cell weighs 0.5 kg.
    EXPECT_LT(frame.report.max_strain, 0.1) << "frame " << frame.report.frame;
    steps += frame.report.steps;
    tried += frame.report.steps + frame.report.rejected_steps;
    iterations += frame.report.newton_iterations;
  }
  // Measured iterations per step: 16 at 40 m with long steps, fewer otherwise. If diverging iterations continued, a
  // step would take up to 400.
  EXPECT_LT(iterations, 20 * steps);
  // Measured tries per step: 1.08 at 40 m with long steps, else 1.
  EXPECT_LT(tried, 1.2 * steps);
}

std::string name_of_scale(const ::testing::TestParamInfo<Scale>& instance) {
  const Scale& scale = instance.param;
  return std::to_string(std::lround(100 * scale.size)) + "cm" + (scale.is_time_scaled ? "TimeScaled" : "");
}

INSTANTIATE_TEST_SUITE_P(At, Tarpaulin,
                         ::testing::Values(Scale{0.02, false, 25}, Scale{1, false, 25}, Scale{40, true, 25}),
                         name_of_scale);
INSTANTIATE_TEST_SUITE_P(SlowAt, Tarpaulin, ::testing::Values(Scale{0.02, true, 25}, Scale{40, false, 60}),
                         name_of_scale);

}  // namespace
}  // namespace weft::simulation
