// Measurements of error against run time: shapes, comparisons, complete measurements of a small sheet, tables and
// plots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "cli/subprocess.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/run_error/shadow.hpp"
#include "film/run_error/trajectory.hpp"
#include "lab/bench/accuracy_report.hpp"
#include "lab/bench/plot.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::bench {
namespace {

using namespace run_error;

using cli::contains;
using scene::Integrator;
using Triangles = std::vector<mesh::Triangle>;

// A rectangle of 0.6 m by 0.5 m in the xy plane, rotated by `rotation` and moved to `middle`.
std::vector<Vec3> rectangle(const Quat& rotation, const Vec3& middle = Vec3::Zero()) {
  std::vector<Vec3> x{{-0.3, -0.25, 0}, {0.3, -0.25, 0}, {0.3, 0.25, 0}, {-0.3, 0.25, 0}};
  for (Vec3& point : x) point = middle + rotation * point;
  return x;
}
const Triangles kRectangle{{0, 1, 2}, {0, 2, 3}};

Quat turned(double degrees, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}

TEST(Shadow, OfAFlatSheetIsItsAreaHoweverItLies) {
  for (double degrees : {0.0, 10.0, 30.0, 45.0, 77.0})
    EXPECT_NEAR(shadow_area(kRectangle, rectangle(turned(degrees, Vec3::UnitZ())), Vec3::UnitZ()), 0.3, 1e-6);
}

TEST(Shadow, OfATiltedSheetGoesByTheCosine) {
  EXPECT_NEAR(shadow_area(kRectangle, rectangle(turned(60, Vec3(1, 2, 0).normalized())), Vec3::UnitZ()), 0.15, 1e-6);
  EXPECT_NEAR(shadow_area(kRectangle, rectangle(turned(90, Vec3::UnitX())), Vec3::UnitY()), 0.3, 1e-6);
}

TEST(Shadow, CountsWhatOverlapsOnce) {
  std::vector<Vec3> x = rectangle(Quat::Identity());
  for (const Vec3& point : rectangle(Quat::Identity(), {0.2, 0.1, 0.4})) x.push_back(point);
  Triangles triangles = kRectangle;
  for (mesh::Triangle t : kRectangle) triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  EXPECT_NEAR(shadow_area(triangles, x, Vec3::UnitZ()), 0.6 - 0.4 * 0.4, 1e-3);
}

TEST(Shadow, OfADiscIsThatOfItsPolygon) {
  constexpr int kCorners = 90;
  std::vector<Vec3> x{Vec3::Zero()};
  Triangles triangles;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    x.emplace_back(0.15 * std::cos(angle), 0.15 * std::sin(angle), 0.02 * k);
    triangles.push_back({0, 1 + k, 1 + (k + 1) % kCorners});
  }
  const double area = 0.5 * kCorners * 0.15 * 0.15 * std::sin(2 * std::numbers::pi / kCorners);
  EXPECT_NEAR(shadow_area(triangles, x, Vec3::UnitZ()), area, 1e-5 * area);
}

Trajectory made_up(const Vec3& shift, const Vec3& velocity, double energy) {
  Trajectory trajectory;
  trajectory.masses = {1, 3};
  trajectory.frames = {{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}},
                       {{{0, 0, 1}, Vec3(1, 0, 1) + shift}, {velocity, {0, 0, 0}}},
                       {{{0, 0, 2}, {1, 0, 2}}, {{0, 0, 0}, {0, 0, 0}}}};
  trajectory.functionals = {.energy = {5, energy, 5.1}, .energies_in_play = 10, .centre = 0.75 * shift};
  return trajectory;
}

TEST(Trajectories, AreComparedByMassAndByTheWorstFrame) {
  const Trajectory exact = made_up(Vec3::Zero(), Vec3::Zero(), 5);
  const Errors errors = run_error::compare(made_up({0.1, 0, 0}, {0, 2, 0}, 5.5), exact);
  const auto error = [&](Quantity q) { return at(errors, q); };
  EXPECT_NEAR(error(Quantity::position), 0.1 * std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(error(Quantity::velocity), 2 * std::sqrt(0.25), 1e-15);
  EXPECT_NEAR(error(Quantity::energy), 0.05, 1e-15);
  EXPECT_EQ(error(Quantity::drift), 0) << "the last frame alone counts";
  EXPECT_NEAR(error(Quantity::centre), 0.075, 1e-15);
  EXPECT_EQ(error(Quantity::top), 0);
}

TEST(Trajectories, WithoutVelocitiesAreComparedByPositions) {
  Trajectory pictures = made_up({0.1, 0, 0}, {0, 2, 0}, 5);
  for (Trajectory::Frame& frame : pictures.frames) frame.v.clear();
  const Errors errors = run_error::compare(pictures, made_up(Vec3::Zero(), Vec3::Zero(), 5));
  EXPECT_EQ(at(errors, Quantity::velocity), 0);
  EXPECT_NEAR(at(errors, Quantity::position), 0.1 * std::sqrt(0.75), 1e-15);
}

TEST(Trajectories, MedianIsThatOfEachNumber) {
  std::vector<Functionals> samples;
  for (double x : {3.0, 1.0, 7.0})
    samples.push_back({.energy = {x, -x}, .shadow = x * x, .top = -x, .rest_energy = 2 * x, .centre = {x, -x, 0}});
  const Functionals middle = median(samples);
  EXPECT_EQ(middle.energy, (std::vector<double>{3, -3}));
  EXPECT_EQ(middle.shadow, 9);
  EXPECT_EQ(middle.top, -3);
  EXPECT_EQ(middle.rest_energy, 6);
  EXPECT_EQ(middle.centre, Vec3(3, -3, 0));
  samples.pop_back();
  EXPECT_EQ(median(samples).shadow, 5) << "between two: their mean";
}

TEST(Trajectories, HoldTheNumbersOfAFlatSheetAtTheEnd) {
  // All particles are pinned. The sheet is tilted by 60 degrees, so its vertical shadow is half of its area. Its middle
  // is 2 m high.
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.08\nintegrator = \"bdf2\"\n[contact]\nself = false\n[[cloth]]\nname = \"a\"\nsize = [0.6, "
      "0.5]\n"
      "particles = [4, 3]\nposition = [1, 0, 2]\nrotation = [60, 0, 0]\nmaterial = { density = 0.5 }\npin = [{}]\n");
  const Trajectory trajectory = follow(scene);
  EXPECT_EQ(trajectory.frames.size(), 2u);
  EXPECT_EQ(trajectory.masses.size(), 12u);
  EXPECT_EQ(trajectory.work.steps, 8);
  const Functionals& end = trajectory.functionals;
  EXPECT_NEAR(end.shadow, 0.5, 1e-6);
  EXPECT_NEAR(end.top, 2 + 0.25 * std::sin(std::numbers::pi / 3), 1e-12);
  EXPECT_LT((end.centre - Vec3(1, 0, 2)).norm(), 1e-12);
  EXPECT_NEAR(end.rest_energy, 0.15 * 9.81 * 2, 1e-9);
  EXPECT_EQ(follow(scene, {.last_frame = 1}).frames.size(), 1u);
  EXPECT_THROW(follow(scene, {.steps = 7}), Error);
  EXPECT_THROW(follow(scene, {.proceed = [] { return false; }}), Error);
}

TEST(Trajectories, ParticlesOfAMeshLieOnThoseOfTheFinerOne) {
  for (const char* shape : {"quads", "aligned_triangles", "crossed_triangles"}) {
    const scene::Scene coarse = support::scene_of_text(fmt::format(
        "[[cloth]]\nname = \"a\"\nshape = \"{0}\"\nsize = [0.6, 0.5]\nparticles = [4, 3]\n[[cloth]]\nname = \"b\"\n"
        "shape = \"{0}\"\nsize = [0.5, 0.7]\nparticles = [3, 6]\nposition = [2, 0, 1]\n",
        shape));
    scene::Scene fine = coarse;
    ASSERT_TRUE(can_refine(coarse, 2));
    EXPECT_FALSE(can_refine(coarse, 0.5)) << "three cells";
    refine(fine, 2);
    const production::SceneSimulation a(coarse), b(fine);
    const auto same = matching_particles_in_refined(coarse);
    ASSERT_EQ(same.size(), a.particles());
    for (std::size_t i = 0; i < same.size(); ++i)
      EXPECT_LT((a.state().positions[i] - b.state().positions[same[i]]).norm(), 1e-14) << shape << " " << i;
  }
}

TEST(Trajectories, MeshesFromElsewhereAreNotRefined) {
  scene::Scene scene = support::scene_of_text("[[cloth]]\nname = \"a\"\nparticles = 5\n");
  EXPECT_TRUE(can_refine(scene, 0.5));
  for (const auto shape : {scene::ClothShape::mesh, scene::ClothShape::pattern}) {
    scene.cloths[0].shape = shape;
    EXPECT_FALSE(can_refine(scene, 0.5));
  }
}

// The swinging sheet, with fewer particles and a shorter duration.
scene::Scene small_sheet(const std::vector<std::string>& more = {}) {
  return support::scene_of_text(kSwingingSheet, cli::joined({"cloth.sheet.particles=6", "time.duration=0.2"}, more));
}

const Accuracy& measured() {
  static const Accuracy kMeasured = measure_accuracy(small_sheet());
  return kMeasured;
}

TEST(AccuracyOfASheet, ObservedOrdersAreThoseOfTheMethods) {
  for (Integrator integrator : kIntegrators) {
    const auto series = measured().step_limited_runs(integrator);
    ASSERT_EQ(series.size(), 6u) << "each step was solved so exactly that it decides";
    const bench::Run &coarse = *series[4], &fine = *series[5];
    EXPECT_DOUBLE_EQ(control_of(coarse), 2 * control_of(fine));
    for (Quantity q : {Quantity::position, Quantity::energy}) {
      ASSERT_TRUE(measured().resolved(fine, q));
      // Tolerance of the order: 0.1 is measured. Causes are the next term of the error, and the solver, which may add a
      // tenth of the error.
      EXPECT_NEAR(std::log2(error_of(coarse, q) / error_of(fine, q)), expected_order(fine), 0.25) << name_of(q);
    }
  }
}

TEST(AccuracyOfASheet, StepLimitedRunsHardlyChangeAtATenthOfTheTolerance) {
  for (Integrator integrator : kIntegrators) {
    const auto grid = measured().series(Axis::grid, integrator);
    for (std::size_t k = 0; k < grid.size(); ++k) {
      if (!grid[k]->is_step_limited) continue;
      ASSERT_LT(k + 1, grid.size());
      const bench::Run& tighter = *grid[k + 1];
      EXPECT_EQ(tighter.setting.step, grid[k]->setting.step);
      EXPECT_NEAR(tighter.setting.newton_tolerance, 0.1 * grid[k]->setting.newton_tolerance, 1e-15);
      EXPECT_LE(grid[k]->change, std::max(0.1 * error_of(tighter, Quantity::position),
                                          measured().uncertainty_of(tighter, Quantity::position)));
    }
  }
}

TEST(AccuracyOfASheet, ErrorsFallWithTheTolerancesOfStepsAndSolver) {
  const auto tolerances = measured().series(Axis::tolerance, Integrator::bdf2);
  ASSERT_GE(tolerances.size(), 5u);
  EXPECT_LT(tolerances.back()->errors[0], 0.1 * tolerances.front()->errors[0]);
  const bench::Run &loose = *measured().series(Axis::grid, Integrator::bdf2).front(),
                   &exact = *measured().step_limited_runs(Integrator::bdf2).front();
  EXPECT_EQ(loose.setting.step, exact.setting.step);
  EXPECT_LE(exact.solver_error, loose.solver_error);
}

TEST(AccuracyOfASheet, ReferenceIsTheBetterKnownOfTwo) {
  const Accuracy& accuracy = measured();
  EXPECT_EQ(accuracy.reference.setting.integrator, Integrator::implicit_midpoint);
  EXPECT_EQ(accuracy.second.setting.integrator, Integrator::bdf2);
  EXPECT_LT(at(accuracy.reference.uncertainty(), Quantity::position),
            at(accuracy.second.uncertainty(), Quantity::position));
  EXPECT_GE(at(accuracy.uncertainty, Quantity::position), at(accuracy.reference.uncertainty(), Quantity::position));
  EXPECT_GT(at(accuracy.difference, Quantity::position), 0);
  // The uncertainty is the difference between the reference and a run with twice its step. Relative to the error of the
  // finest run in the table, this is 1/16 − 1/64 = 3/64. The solver adds about as much.
  EXPECT_LT(at(accuracy.uncertainty, Quantity::position),
            0.1 * error_of(*accuracy.step_limited_runs(Integrator::implicit_midpoint).back(), Quantity::position));
}

TEST(AccuracyOfASheet, FailsOnlyWithBothReferences) {
  support::expect_error(ExitCode::simulation_failed, "the reference run failed: ", [] {
    measure_accuracy(small_sheet({"solver.newton_iterations=1", "solver.halvings=0"}));
  });
}

// A row of the table of runs. Units as in the table's header.
struct Row {
  std::string axis, integrator;
  double step, tolerance, newton, cpu, error, uncertainty;
  bool failed;
};

std::vector<Row> rows_of(const std::string& csv, const std::string& error, const std::string& uncertainty) {
  std::istringstream lines(csv);
  std::string line;
  std::map<std::string, std::size_t> columns;
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream parts(line + ",");
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    if (columns.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) columns[fields[i]] = i;
      continue;
    }
    const auto number = [&](const std::string& name) {
      const std::string& field = fields.at(columns.at(name));
      return field.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(field);
    };
    rows.push_back({fields.at(0), fields.at(1), number("step_s"), number("tolerance_m"), number("newton_tolerance"),
                    number("cpu_s"), number(error), number(uncertainty), !fields.at(columns.at("failure")).empty()});
  }
  return rows;
}

// Like cheapest(): describes the row with the least CPU time whose error plus uncertainty is within the target [m], and
// for which this is also true of all finer rows.
std::string cheapest_of(const std::vector<Row>& rows, double target) {
  const auto reaches = [&](const Row& row) { return row.error + row.uncertainty <= target; };
  const auto finer = [](const Row& a, const Row& b) {
    if (a.axis != b.axis || a.integrator != b.integrator) return false;
    return a.axis == "tolerance" ? a.tolerance < b.tolerance : a.step <= b.step && a.newton <= b.newton;
  };
  const Row* best = nullptr;
  for (const Row& row : rows) {
    if (row.failed || (row.axis != "grid" && row.axis != "tolerance") || !reaches(row)) continue;
    const bool lucky = std::any_of(rows.begin(), rows.end(), [&](const Row& other) {
      return !other.failed && finer(other, row) && !reaches(other);
    });
    if (!lucky && (best == nullptr || row.cpu < best->cpu)) best = &row;
  }
  if (best == nullptr) return "no run is known to be as exact";
  return best->axis == "tolerance" ? fmt::format("{}, tolerance {:.3g} m", best->integrator, best->tolerance)
                                   : fmt::format("{}, step {:.4g} ms, newton_tolerance {:.1g}", best->integrator,
                                                 1e3 * best->step, best->newton);
}

TEST(AccuracyOfASheet, ConclusionFollowsFromTheTable) {
  const auto rows = rows_of(csv(accuracy_table(measured())), "position [m]", "position doubt");
  ASSERT_EQ(rows.size(), measured().runs.size());
  const std::string text = conclusion(measured());
  for (const auto& [target, words] : {std::pair{0.01, "of 0.01 m: "}, {0.001, "; 0.001 m: "}, {0.0001, "; 0.0001 m: "}})
    EXPECT_TRUE(contains(text, words + cheapest_of(rows, target))) << target << "\n" << text;
  // The text also gives the error of the solver at the settings of the scene.
  const auto at_scene_settings = std::find_if(rows.begin(), rows.end(), [](const Row& row) {
    return row.axis == "grid" && row.integrator == "implicit_euler" && row.step == 0.01 &&
           row.newton == scene::Solver{}.newton_tolerance;
  });
  ASSERT_NE(at_scene_settings, rows.end());
  const auto& run = measured().runs[static_cast<std::size_t>(at_scene_settings - rows.begin())];
  EXPECT_TRUE(contains(text, fmt::format("the solver {:.1e} m", run.solver_error))) << text;
}

TEST(AccuracyWithContact, ComparesMediansOfSeveralStarts) {
  const Accuracy accuracy = measure_accuracy(support::scene_of_text(
      "[time]\nduration = 0.12\n[[cloth]]\nname = \"a\"\nsize = 0.3\nparticles = 5\nposition = [0, 0, 0.105]\n"
      "[[obstacle]]\nname = \"b\"\nshape = \"sphere\"\nradius = 0.1\n"));
  EXPECT_TRUE(accuracy.contact);
  EXPECT_EQ(deciding_quantity(accuracy), Quantity::centre);
  bool spread = false;
  for (const bench::Run& run : accuracy.runs) {
    EXPECT_EQ(error_of(run, Quantity::position), run.axis == Axis::mesh ? error_of(run, Quantity::position) : 0);
    spread = spread || at(run.spread, Quantity::centre) > 0;
    EXPECT_LE(at(run.spread, Quantity::centre), accuracy.uncertainty_of(run, Quantity::centre));
  }
  EXPECT_TRUE(spread);
  EXPECT_FALSE(contains(accuracy_markdown("x", accuracy, "a", "b"), "position ["));
}

TEST(AccuracyWhereNothingMoves, SaysSoWithoutInfinities) {
  const Accuracy accuracy = measure_accuracy(small_sheet({"physics.gravity=[0,0,0]", "time.duration=0.08"}));
  const std::string text = accuracy_markdown("x", accuracy, "a", "b") + csv(accuracy_table(accuracy)) +
                           work_svg("x", accuracy) + settings_svg("x", accuracy);
  EXPECT_TRUE(contains(text, "Nothing moves"));
  // The errors are rounding errors. The text must not divide them by zero.
  for (const bench::Run& run : accuracy.runs) EXPECT_LT(error_of(run, Quantity::energy), 1e-9);
  for (const char* word : {"inf", "nan"}) EXPECT_FALSE(contains(text, word)) << word;
}

// Made-up results for steps of 40 ms / n: Euler has errors of 19.4 mm / n and takes n CPU s; midpoint has errors of
// 19.4 mm / n² and takes 2 n CPU s.
Accuracy made_up_accuracy() {
  Accuracy accuracy;
  accuracy.uncertainty.fill(1e-7);
  for (int k = 0; k < 9; ++k) {
    const double n = std::pow(2, k);
    bench::Run euler{.setting = {.integrator = Integrator::implicit_euler, .step = 0.04 / n, .newton_tolerance = 0.1},
                     .is_step_limited = true};
    euler.errors.fill(0.0194 / n);
    euler.work.cpu_s = n;
    bench::Run midpoint = euler;
    midpoint.setting.integrator = Integrator::implicit_midpoint;
    midpoint.errors.fill(0.0194 / (n * n));
    midpoint.work.cpu_s = 2 * n;
    accuracy.runs.push_back(euler);
    accuracy.runs.push_back(midpoint);
  }
  return accuracy;
}

TEST(Conclusion, NamesTheCheapestSettingForEachAccuracyAndTheCostOfADigit) {
  const std::string text = conclusion(made_up_accuracy());
  EXPECT_TRUE(contains(text, "0.01 m: implicit_euler, step 20 ms, newton_tolerance 0.1 (2 CPU s, error 9.7e-03 m)"))
      << text;
  EXPECT_TRUE(contains(text, "0.001 m: implicit_midpoint, step 5 ms, newton_tolerance 0.1 (16 CPU s")) << text;
  // One more digit needs ten times the steps with Euler, √10 times with midpoint.
  EXPECT_TRUE(contains(text, "implicit_euler 10.0 times and unknown, implicit_midpoint 3.2 times")) << text;
}

TEST(Conclusion, DoesNotPromiseWhatTheReferenceDoesNotKnow) {
  Accuracy accuracy = made_up_accuracy();
  accuracy.uncertainty.fill(5e-5);
  const std::string text = conclusion(accuracy);
  EXPECT_TRUE(contains(text, "0.0001 m: the reference is not known so exactly")) << text;
  EXPECT_TRUE(contains(text, "1.7e-04 m, as exact as this report can show: implicit_midpoint, step 2.5 ms")) << text;
  // The tables mark this value as uncertain, too.
  const bench::Run& fine = *accuracy.series(Axis::grid, Integrator::implicit_midpoint).back();
  EXPECT_FALSE(accuracy.resolved(fine, Quantity::position));
  EXPECT_TRUE(contains(accuracy_markdown("x", accuracy, "a", "b"), fmt::format("~{:.1e}", fine.errors[0])));
}

TEST(Conclusion, LeavesOutRunsThatFailedAndTheReportListsThemWithTheirReason) {
  Accuracy accuracy = made_up_accuracy();
  accuracy.runs[2].failure = "frame 3: it went | wrong";
  EXPECT_EQ(cheapest(accuracy, Quantity::position, 0.01), &accuracy.runs[3]);
  const std::string text = accuracy_markdown("x", accuracy, "a.svg", "b.svg");
  EXPECT_TRUE(contains(text, "| implicit_euler | 20 ms, newton_tolerance 0.1 | frame 3: it went \\| wrong |")) << text;
  const Table table = accuracy_table(accuracy);
  EXPECT_EQ(table.size(), accuracy.runs.size() + 1);
  EXPECT_EQ(table[3].back(), "frame 3: it went | wrong");
}

TEST(Conclusion, TakesNoRowThatIsExactByLuckOrWhoseStartsDisagree) {
  Accuracy accuracy = made_up_accuracy();
  // This run is very cheap and very accurate, but the run with half its step is not.
  bench::Run& lucky = accuracy.runs[0];
  lucky.errors.fill(1e-5);
  accuracy.runs[2].errors.fill(0.05);
  EXPECT_EQ(cheapest(accuracy, Quantity::position, 0.01), &accuracy.runs[3]);
  accuracy.runs[3].spread.fill(0.02);
  EXPECT_EQ(cheapest(accuracy, Quantity::position, 0.01), &accuracy.runs[4]);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Plot, PlacesPointsOnLogarithmicAxesAndLeavesOutWhatIsNotPositive) {
  const Panel panel{"t", "x", "y", {{"c", "red", Marker::circle, false, {{1, 1}, {10, 10}, {100, 100}, {5, 0}}}}, {}};
  const std::string svg = log_log_svg({panel});
  std::vector<Vec2> points;
  for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + at, "<circle cx='%lf' cy='%lf'", &x, &y), 2);
    points.emplace_back(x, y);
  }
  ASSERT_EQ(points.size(), 4u) << "three points and the name's";
  EXPECT_LT((points[0] + points[2] - 2 * points[1]).norm(), 0.2);
  EXPECT_LT(points[2].y(), points[0].y());
  EXPECT_FALSE(contains(svg, "nan"));
  EXPECT_FALSE(contains(svg, "inf"));
}

TEST(Plot, WritesATitleAsText) {
  const std::string svg = log_log_svg({{"silk & <wool>", "x", "y", {}, {}}});
  EXPECT_TRUE(contains(svg, ">silk &amp; &lt;wool")) << svg;
}

TEST(Plot, NamesDecadesAndWhereThereAreFewTheirParts) {
  const auto svg_of = [](double low, double high) {
    return log_log_svg({{"t", "x", "y", {{"c", "red", Marker::circle, false, {{low, low}, {high, high}}}}, {}}});
  };
  const std::string wide = svg_of(1e-7, 10);
  for (int decade : {-7, -6, -5, -4})
    EXPECT_EQ(count_of(wide, fmt::format(">10<tspan dy='-4' font-size='8'>{}</tspan>", decade)), 2u) << "on both axes";
  for (const char* name : {">0.001<", ">0.1<"}) EXPECT_EQ(count_of(wide, name), 2u);
  const std::string narrow = svg_of(2e-5, 3e-5);
  for (const char* part : {"2", "2.5", "3"})
    EXPECT_EQ(count_of(narrow, fmt::format(">{}·10<tspan dy='-4' font-size='8'>-5</tspan>", part)), 2u) << part;
}

TEST(Plot, DrawsNoLineThroughPointsThatAreNoSeries) {
  Curve curve{"c", "red", Marker::circle, false, {{1, 1}, {10, 10}}};
  EXPECT_EQ(count_of(log_log_svg({{"t", "x", "y", {curve}, {}}}), "stroke='red'"), 2u) << "and in the name";
  curve.line = false;
  EXPECT_EQ(count_of(log_log_svg({{"t", "x", "y", {curve}, {}}}), "stroke='red'"), 0u);
}

class BenchAccuracy : public support::TestFolder {};

TEST_F(BenchAccuracy, WritesReportTableAndPlots) {
  const cli::Outcome outcome = cli::run_weft(
      {"bench", "accuracy", "--set", "cloth.sheet.particles=6", "--set", "time.duration=0.04", "-o", "b"}, folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "Cheapest for an error of the position of 0.01 m: "));
  EXPECT_TRUE(contains(outcome.err, " left"));
  std::istringstream csv(support::read_bytes(folder_ / "b" / "accuracy_swinging_sheet.csv"));
  std::string line;
  std::size_t lines = 0, commas = 0;
  while (std::getline(csv, line)) {
    if (lines++ == 0) commas = count_of(line, ",");
    EXPECT_EQ(count_of(line, ","), commas) << line;
  }
  EXPECT_GT(lines, 60u);
  for (const char* name : {"accuracy_swinging_sheet.svg", "accuracy_swinging_sheet_settings.svg"}) {
    const std::string svg = support::read_bytes(folder_ / "b" / name);
    EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    EXPECT_EQ(count_of(svg, "<g "), count_of(svg, "</g>"));
    EXPECT_EQ(count_of(svg, "<text"), count_of(svg, "</text>"));
    EXPECT_TRUE(contains(support::read_bytes(folder_ / "b" / "accuracy_swinging_sheet.md"), name));
  }
}

TEST_F(BenchAccuracy, ASceneWithoutAFrameAfterTheStartIsRefused) {
  expect_exit(cli::run_weft({"bench", "accuracy", "--set", "time.duration=0", "-o", "b"}, folder_), 3,
              "time.duration: expected at least one frame after frame 0");
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace weft::bench
