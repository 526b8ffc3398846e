// Verdicts on runs, and tables of verdicts.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lab/bench/report.hpp"
#include "lab/bench/stability.hpp"
#include "support/scene_runs.hpp"

namespace weft::bench {
namespace {

const ExtremeCase& case_named(const std::string& name) {
  for (const ExtremeCase& extreme : extreme_cases())
    if (extreme.name == name) return extreme;
  throw std::invalid_argument(name);
}

Outcome outcome_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  const ExtremeCase& extreme = case_named(name);
  return try_scene(support::scene_of_text(extreme.text, overrides), std::min(extreme.frames, 10), extreme.driven);
}

TEST(Stability, EveryExtremeCaseIsAScene) {
  EXPECT_GE(extreme_cases().size(), 15u);
  for (const ExtremeCase& extreme : extreme_cases()) {
    SCOPED_TRACE(extreme.name);
    EXPECT_NO_THROW(support::scene_of_text(extreme.text));
  }
}

TEST(Stability, SmallExtremeCasesAreSolved) {
  for (const char* name : {"light",
                           "heavy",
                           "ratio_1e4",
                           "load",
                           "gravity",
                           "flattened",
                           "point",
                           "randomised",
                           "stretched",
                           "pin_jumps",
                           "no_stiffness",
                           "no_gravity",
                           "one_element",
                           "slope_friction_0",
                           "slope_friction_10",
                           "ball_friction_0",
                           "ball_friction_10",
                           "solved_loosely",
                           "crossed_triangles",
                           "far_away"}) {
    const Outcome outcome = outcome_of(name);
    EXPECT_EQ(outcome.verdict, Verdict::solved) << name << ": " << outcome.reason;
    EXPECT_EQ(outcome.frames, 10) << name;
  }
}

TEST(Stability, WhatCannotBeSolvedIsRefusedWithItsReason) {
  const Outcome outcome = outcome_of("ratio_1e8", {"solver.newton_iterations=1", "solver.halvings=0"});
  EXPECT_EQ(outcome.verdict, Verdict::refused);
  EXPECT_NE(outcome.reason.find("Newton's method did not reach its tolerance"), std::string::npos) << outcome.reason;
}

TEST(Stability, MoreEnergyThanDrivesItIsUnbounded) {
  const ExtremeCase& jump = case_named("pin_jumps");
  // The stretch limit is off; with it, the run would give a warning.
  const scene::Scene scene = support::scene_of_text(jump.text, {"cloth.sheet.material.max_stretch=0"});
  EXPECT_EQ(try_scene(scene, 10, 1e-3).verdict, Verdict::unbounded);
}

TEST(Stability, PeriodsAreThoseOfAPlateAndOfAChain) {
  // A plate half a metre long that hangs from its edge has the period 2π √(2 L / 3 g). In a chain of masses
  // m = 0.2 kg/m² · (50 mm)² and springs k = 1000 N/m, neighbours oscillate in opposite phase with the angular
  // frequency 2 √(k / m).
  EXPECT_NEAR(swing_period(), 1.1582, 1e-4);
  EXPECT_NEAR(stiffest_period(1000), 2 * std::numbers::pi / (2 * std::sqrt(1000 / (0.2 * 0.05 * 0.05))), 1e-12);
}

TEST(Report, TallyCountsEachVerdictAndWhatIsWrong) {
  Tally tally;
  for (const Verdict verdict :
       {Verdict::solved, Verdict::solved, Verdict::refused, Verdict::warned, Verdict::unbounded, Verdict::not_finite})
    tally.add(verdict);
  EXPECT_EQ(tally.text(), "2 solved, 1 refused, 1 warned of, 1 unbounded, 1 not finite");
  EXPECT_EQ(tally.wrong(), 2);
}

TEST(Report, FieldsWithCommasQuotesAndLinesAreQuoted) {
  EXPECT_EQ(csv({{"a", "b"}, {"1,2", "say \"x\""}, {"two\nlines", ""}}),
            "a,b\n\"1,2\",\"say \"\"x\"\"\"\n\"two\nlines\",\n");
}

TEST(Report, MarkdownHasARuleUnderTheHeaderAndEscapesBars) {
  EXPECT_EQ(markdown({{"a", "b"}, {"x|y", "1"}}), "| a | b |\n|---|---|\n| x\\|y | 1 |\n");
}

TEST(Report, MapHasAColoredCellForEachRun) {
  std::vector<MapCell> cells(2);
  cells[0] = {scene::Integrator::implicit_euler, 100, 0.01, {}};
  cells[1] = {scene::Integrator::bdf2, 100, 0.1, {.verdict = Verdict::refused, .reason = "why"}};
  const std::string svg = map_svg(cells);
  EXPECT_NE(svg.find("#7fbf7b"), std::string::npos);
  EXPECT_NE(svg.find("#f1c453"), std::string::npos);
  cells[1].swings = 1.95;
  cells[1].stiffest_periods = 12'000;
  EXPECT_EQ(map_table(cells)[2][4], "1.9");
  EXPECT_EQ(map_table(cells)[2][5], "1.2e+04");
  EXPECT_EQ(map_table(cells).size(), 3u);
  EXPECT_EQ(map_table(cells)[2].back(), "why");
}

}  // namespace
}  // namespace weft::bench
