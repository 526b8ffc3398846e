// Measurements of error against run time: options of the user, first line of the report, check of the reference, page
// of results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/subprocess.hpp"
#include "lab/bench/accuracy_report.hpp"
#include "lab/bench/html.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"
#include "tools/cli/options.hpp"

namespace weft::bench {
namespace {

using cli::contains;
using scene::Integrator;

scene::Scene tiny_sheet(const std::vector<std::string>& more = {}) {
  return support::scene_of_text(kSwingingSheet, cli::joined({"cloth.sheet.particles=5", "time.duration=0.08"}, more));
}

std::set<double> controls(const Accuracy& accuracy, Axis axis) {
  std::set<double> values;
  for (const bench::Run& run : accuracy.runs)
    if (run.axis == axis) values.insert(std::round(1e9 * control_of(run)) / 1e9);
  return values;
}

TEST(AccuracyPlan, MeasuresWhatItNamesAndNothingElse) {
  AccuracyPlan plan;
  plan.integrators = {Integrator::bdf2, Integrator::implicit_euler};
  plan.steps = {0.5, 1};
  plan.tolerances = {1e-4};
  plan.meshes = {1};
  plan.starts = 2;
  const Accuracy accuracy = measure_accuracy(tiny_sheet(), {}, plan);
  EXPECT_EQ(controls(accuracy, Axis::grid), (std::set<double>{0.005, 0.01}));
  EXPECT_EQ(controls(accuracy, Axis::tolerance), (std::set<double>{1e-4}));
  EXPECT_EQ(controls(accuracy, Axis::mesh), (std::set<double>{1}));
  EXPECT_TRUE(accuracy.series(Axis::grid, Integrator::implicit_midpoint).empty());
  EXPECT_FALSE(accuracy.series(Axis::grid, Integrator::bdf2).empty());
  for (const bench::Run* run : accuracy.series(Axis::grid, Integrator::bdf2)) EXPECT_EQ(run->start_errors.size(), 2u);
  EXPECT_EQ(accuracy.cross_checks.size(), 2u) << "one for each integrator";
}

TEST(AccuracyPlan, LeavesAxesOut) {
  AccuracyPlan plan;
  plan.integrators = {Integrator::bdf2};
  plan.steps = {1};
  plan.tolerances.emplace();
  plan.meshes.emplace();
  const Accuracy accuracy = measure_accuracy(tiny_sheet(), {}, plan);
  EXPECT_TRUE(runs_of_axis(accuracy, Axis::tolerance).empty());
  EXPECT_TRUE(runs_of_axis(accuracy, Axis::mesh).empty());
  EXPECT_TRUE(accuracy.cross_checks.empty()) << "a single step shows nothing of its own error";
  EXPECT_TRUE(contains(accuracy_markdown("x", accuracy, "a", "b"), "no other run checks the reference"));
}

TEST(AccuracyPlan, HoldsTheSceneAsItStandsWhateverItsStep) {
  for (const auto& [step, steps_a_frame] : {std::pair{0.02, 2}, {0.008, 5}, {0.1, 1}}) {
    AccuracyPlan plan;
    plan.integrators = {Integrator::implicit_euler};
    plan.tolerances.emplace();
    plan.meshes.emplace();
    const Accuracy accuracy = measure_accuracy(tiny_sheet({fmt::format("time.step={}", step)}), {}, plan);
    const bench::Run* at_scene_settings = accuracy.scene_setting_run();
    ASSERT_NE(at_scene_settings, nullptr) << step;
    EXPECT_EQ(at_scene_settings->work.steps, 2 * steps_a_frame) << "in two frames";
  }
  AccuracyPlan plan;
  plan.integrators = {Integrator::implicit_euler};
  plan.steps = {0.5};
  plan.tolerances = {1e-4};
  const Accuracy accuracy = measure_accuracy(tiny_sheet({"time.tolerance=3e-4"}), {}, plan);
  ASSERT_NE(accuracy.scene_setting_run(), nullptr);
  EXPECT_EQ(accuracy.scene_setting_run()->setting.tolerance, 3e-4);
}

TEST(AccuracyPlan, SolvesNothingLessExactlyThanTheScene) {
  constexpr double kScene = 5e-9;  // below 1e-8, the lowest value at which the program divides newton_tolerance by ten
  AccuracyPlan plan;
  plan.integrators = {Integrator::bdf2};
  plan.steps = {1};
  plan.tolerances.emplace();
  plan.meshes = {1};
  int references = 0, looser = 0;
  const auto check = [&](const bench::Run& run, double) {
    if (run.setting.newton_tolerance > kScene) ++looser;
    if (run.setting.step < 0.01) ++references;
  };
  const Accuracy accuracy =
      measure_accuracy(tiny_sheet({fmt::format("solver.newton_tolerance={}", kScene)}), check, plan);
  EXPECT_GT(references, 0);
  EXPECT_EQ(looser, 3) << "one for each reference and for the step, by which the error of the solver is known";
  for (const bench::Run& run : accuracy.runs) EXPECT_LE(run.setting.newton_tolerance, kScene);
  for (const Candidate* each : {&accuracy.reference, &accuracy.second})
    EXPECT_LE(each->setting.newton_tolerance, kScene);
  EXPECT_FALSE(runs_of_axis(accuracy, Axis::mesh).empty());
  ASSERT_EQ(step_limited_runs(accuracy).size(), 1u);
  EXPECT_TRUE(std::isnan(step_limited_runs(accuracy)[0]->solver_error)) << "no run is solved more exactly";
  EXPECT_TRUE(contains(conclusion(accuracy), "the solver is not known")) << conclusion(accuracy);
}

TEST(AccuracyPlan, IsRefusedWhereItDoesNotSuitTheScene) {
  AccuracyPlan few;
  few.starts = 2;
  support::expect_error(ExitCode::usage, "--starts: expected at least 3, as surfaces may touch", [&] {
    measure_accuracy(support::scene_of_text("[time]\nduration = 0.08\n[[cloth]]\nname = \"a\"\nparticles = 5\n"), {},
                     few);
  });
  AccuracyPlan odd;
  odd.meshes = {0.3};
  support::expect_error(ExitCode::usage, "--meshes: expected factors that give whole numbers of cells",
                        [&] { measure_accuracy(tiny_sheet(), {}, odd); });
}

TEST(AccuracyReference, IsAsUncertainAsItsCrossChecksShow) {
  Errors uncertainty{};
  uncertainty.fill(0.22e-3);
  CrossCheck agrees, differs;
  agrees.difference.fill(1e-3), agrees.uncertainty.fill(0.9e-3);
  differs.difference.fill(2.1e-3), differs.uncertainty.fill(0.1e-3);
  raise_uncertainty(uncertainty, {agrees});
  EXPECT_DOUBLE_EQ(at(uncertainty, Quantity::position), 0.22e-3);
  raise_uncertainty(uncertainty, {agrees, differs});
  EXPECT_DOUBLE_EQ(at(uncertainty, Quantity::position), 2e-3);
}

// Made-up results for a sheet of 1 m and steps of 40 ms / n: Euler has errors of 80 mm / n and takes n CPU s; BDF2 has
// errors of 80 mm / n² and takes 1.5 n CPU s. The scene uses Euler with steps of 10 ms.
Accuracy accuracy_of_one_metre() {
  Accuracy accuracy;
  accuracy.cloth_size = 1;
  accuracy.uncertainty.fill(1e-6);
  accuracy.of_scene = {.integrator = Integrator::implicit_euler, .step = 0.01, .newton_tolerance = 0.1};
  for (int k = 0; k < 6; ++k) {
    const double n = std::pow(2, k);
    bench::Run euler{.setting = {.integrator = Integrator::implicit_euler, .step = 0.04 / n, .newton_tolerance = 0.1},
                     .is_step_limited = true};
    euler.errors.fill(0.08 / n);
    euler.work.cpu_s = n;
    bench::Run bdf2 = euler;
    bdf2.setting.integrator = Integrator::bdf2;
    bdf2.errors.fill(0.08 / (n * n));
    bdf2.work.cpu_s = 1.5 * n;
    accuracy.runs.push_back(euler);
    accuracy.runs.push_back(bdf2);
  }
  return accuracy;
}

TEST(Recommendation, IsTheFirstLineAndNamesKeysAndCosts) {
  Accuracy accuracy = accuracy_of_one_metre();
  EXPECT_EQ(recommendation(accuracy),
            "Use `time.integrator = \"bdf2\"`, `time.step = 0.01`, `solver.newton_tolerance = 0.1`: 6 CPU s, the "
            "position off by at most 5 mm, for an accuracy of 10 mm (1 % of the cloth's size); the settings of the "
            "scene take 4 CPU s, the position off by at most 20 mm.");
  EXPECT_TRUE(accuracy_markdown("x", accuracy, "a", "b")
                  .starts_with("# Error against run time: x\n\n**" + recommendation(accuracy) + "**\n"));
  Accuracy with_contact = accuracy;
  with_contact.contact = true;
  EXPECT_TRUE(
      contains(recommendation(with_contact), "the centre off by at most 5 mm in the last frame, for an accuracy"))
      << recommendation(with_contact);
  accuracy.of_scene.integrator = Integrator::bdf2;
  EXPECT_TRUE(recommendation(accuracy).starts_with("Keep the settings of the scene, `time.integrator = \"bdf2\"`"));
  accuracy.uncertainty.fill(0.5);
  EXPECT_TRUE(recommendation(accuracy).starts_with("No setting that was tried is known to keep the position within"))
      << recommendation(accuracy);
  accuracy.of_scene.step = 1;
  EXPECT_TRUE(
      recommendation(accuracy).ends_with("the settings of the scene were not measured, or do not reach its end."));
}

TEST(Recommendation, SaysThatASettingMayBeExactByChance) {
  Accuracy accuracy = accuracy_of_one_metre();
  for (bench::Run& run : accuracy.runs) run.errors.fill(0.02);
  EXPECT_FALSE(contains(recommendation(accuracy), "chance")) << recommendation(accuracy);
  accuracy.runs[0].errors.fill(0.005);
  EXPECT_TRUE(contains(recommendation(accuracy),
                       "off by at most 5 mm, which may be chance, as runs that are solved more "
                       "exactly are farther off; the settings of the scene take 4 CPU s"))
      << recommendation(accuracy);
}

TEST(Recommendation, LeavesTheSolverAsItIsAtTheSameCost) {
  Accuracy accuracy = accuracy_of_one_metre();
  for (bench::Run& run : accuracy.runs) run.setting.newton_tolerance = 0.01;
  accuracy.runs.push_back(accuracy.runs[5]);
  accuracy.runs.back().setting.newton_tolerance = 0.1;
  accuracy.runs.back().work.cpu_s = 6.5;
  EXPECT_TRUE(contains(recommendation(accuracy), "`solver.newton_tolerance = 0.1`: 6.5 CPU s"))
      << recommendation(accuracy);
  accuracy.runs.back().work.cpu_s = 7;
  EXPECT_TRUE(contains(recommendation(accuracy), "`solver.newton_tolerance = 0.01`: 6 CPU s"));
}

TEST(Recommendation, IsTheMostExactOfThoseThatCostTheSame) {
  Accuracy accuracy = accuracy_of_one_metre();
  accuracy.runs.push_back(accuracy.runs[5]);
  accuracy.runs.back().setting.step = 0.008;
  accuracy.runs.back().errors.fill(0.0025);
  accuracy.runs.back().work.cpu_s = 6.5;
  EXPECT_TRUE(contains(recommendation(accuracy), "`time.step = 0.008`")) << recommendation(accuracy);
  accuracy.runs.back().work.cpu_s = 7;
  EXPECT_TRUE(contains(recommendation(accuracy), "`time.step = 0.01`")) << recommendation(accuracy);
}

// With 25 frames a second and three steps a frame, a step printed as 0.01333 s would be too short: four steps would be
// needed.
TEST(Recommendation, RoundsStepsUp) {
  Accuracy accuracy = accuracy_of_one_metre();
  for (bench::Run& run : accuracy.runs) run.setting.step = 1.0 / 75;
  accuracy.runs.resize(1);
  accuracy.runs[0].errors.fill(1e-4);
  EXPECT_TRUE(contains(recommendation(accuracy), "`time.step = 0.01334`")) << recommendation(accuracy);
}

TEST(Html, HasHeadingsTablesPlotsAndNoMarkup) {
  const std::string page = html_page(
      "a < b", "# A & b\n\n**Use `x < 1`.**\nand more\n\n| h | i |\n|---|---|\n| 1 \\| 2 | `c` |\n\n![p](p.svg)\n",
      [](const std::string& name) { return "<svg>" + name + "</svg>"; });
  EXPECT_TRUE(contains(page, "<title>a &lt; b</title>"));
  EXPECT_TRUE(contains(page, "<h1>A &amp; b</h1>"));
  EXPECT_TRUE(contains(page, "<p><strong>Use <code>x &lt; 1</code>.</strong> and more</p>")) << page;
  EXPECT_TRUE(
      contains(page,
               "<table>\n<tr><th> h </th><th> i </th></tr>\n<tr><td> 1 | 2 </td><td> <code>c</code> </td></tr>\n"
               "</table>"))
      << page;
  EXPECT_TRUE(contains(page, "<svg>p.svg</svg>"));
}

TEST(Html, KeepsTheOrderOfTablesAndParagraphsWithoutBlankLines) {
  const std::string page = html_page("a", "before\n| h |\n|---|\n| c |\nafter\n", {});
  const std::string body =
      "<p>before</p>\n<table>\n<tr><th> h </th></tr>\n<tr><td> c </td></tr>\n</table>\n<p>after</p>";
  EXPECT_TRUE(contains(page, body)) << page;
}

class BenchAccuracyPlan : public support::TestFolder {};

TEST_F(BenchAccuracyPlan, OptionsDecideWhatThePageHas) {
  const cli::Outcome outcome =
      cli::run_weft({"bench", "accuracy", "--set", "cloth.sheet.particles=5", "--set", "time.duration=0.04",
                     "--integrators", "bdf2", "--steps", "1,2", "--tolerances", "none", "--meshes", "none", "-o", "b"},
                    folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string page = support::read_bytes(folder_ / "b/accuracy_swinging_sheet.html");
  EXPECT_NE(page.find("<svg"), page.rfind("<svg")) << "both plots";
  EXPECT_EQ(page.find("implicit_midpoint, step"), page.rfind("implicit_midpoint, step")) << "the reference alone";
  EXPECT_FALSE(contains(page, "Meshes"));
  EXPECT_EQ(outcome.out.substr(0, outcome.out.find('\n')).find("CPU s") == std::string::npos, false) << outcome.out;
}

TEST_F(BenchAccuracyPlan, MistakesNameTheOptionAndWhatIsExpected) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
    support::expect_error(ExitCode::usage, text, [&] { cli::parse_command_line(cli::joined({"bench"}, words)); });
  };
  refused({"accuracy", "--integrators", "euler"},
          "--integrators: expected implicit_euler or implicit_midpoint or bdf2");
  refused({"accuracy", "--steps", "0"}, "--steps: expected numbers from 0.01 to 100, got 0");
  refused({"accuracy", "--tolerances", "2"}, "--tolerances: expected lengths from 1e-09 to 1 m, got 2");
  refused({"accuracy", "--meshes", "x"}, "--meshes: expected numbers from 0.01 to 100, got x");
  refused({"accuracy", "--starts", "0"}, "--starts: ");
  refused({"speed", "--starts", "3"}, "weft bench: --starts is for weft bench accuracy");
  refused({"accuracy", "--sizes", "1"}, "weft bench: --sizes is for weft bench speed");
  refused({"fabrics", "--steps", "1"}, "weft bench: --steps is for weft bench speed or accuracy");
}

}  // namespace
}  // namespace weft::bench
