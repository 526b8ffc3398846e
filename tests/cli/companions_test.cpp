// The reported error estimate of runs, compared with their true error.
#include "film/run_error/companions.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/subprocess.hpp"
#include "core/error.hpp"
#include "lab/bench/accuracy.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"
#include "tools/cli/error_report.hpp"

namespace weft::bench {
namespace {

using namespace run_error;

using cli::contains;

scene::Scene swinging(const std::vector<std::string>& more = {}) {
  return support::scene_of_text(kSwingingSheet, cli::joined({"cloth.sheet.particles=9", "time.duration=0.4"}, more));
}

double part_of(const ErrorEstimate& estimate, ErrorSource source, Quantity quantity = Quantity::position) {
  for (const ErrorPart& part : estimate.parts)
    if (part.source == source) return at(part.errors, quantity);
  return -1;
}

ErrorEstimate estimate_of(const scene::Scene& scene, const CompanionOptions& options = {}) {
  return estimate_error(scene, follow(scene), options);
}

// The reference: a method of second order, with a sixteenth of the scene's step (10 ms) and a Newton tolerance of 1e-6.
const Trajectory& truth() {
  static const Trajectory kTruth = follow(swinging({"time.integrator=implicit_midpoint", "time.step=0.000625",
                                                    "solver.newton_tolerance=1e-6", "solver.linear_tolerance=1e-3"}));
  return kTruth;
}

TEST(Companions, TellTheErrorWithinAFactorOfThree) {
  for (const char* integrator : {"implicit_euler", "implicit_midpoint", "bdf2"}) {
    for (const char* step : {"0.04", "0.02", "0.01", "0.0025"}) {
      const scene::Scene scene =
          swinging({fmt::format("time.integrator={}", integrator), fmt::format("time.step={}", step)});
      const Trajectory run = follow(scene);
      const ErrorEstimate estimate = estimate_error(scene, run);
      EXPECT_FALSE(estimate.is_chaotic) << integrator << " " << step;
      const double ratio = at(estimate.all, Quantity::position) / at(compare(run, truth()), Quantity::position);
      EXPECT_GT(ratio, 1 / 3.0) << integrator << " " << step;
      EXPECT_LT(ratio, 3.0) << integrator << " " << step;
    }
  }
}

TEST(Companions, NameTheSourceOfTheError) {
  const ErrorEstimate steps = estimate_of(swinging({"time.step=0.02", "solver.newton_tolerance=1e-3"}));
  EXPECT_EQ(steps.largest().source, ErrorSource::steps);
  EXPECT_LT(part_of(steps, ErrorSource::solver), 0.1 * part_of(steps, ErrorSource::steps));
  EXPECT_EQ(part_of(steps, ErrorSource::mesh), -1) << "not asked for";
  EXPECT_TRUE(contains(cli::error_sentence(steps, 0.5), "most of it due to the time steps; a smaller time.step"));
  ErrorEstimate solver;
  for (ErrorSource source : {ErrorSource::steps, ErrorSource::solver, ErrorSource::start}) {
    solver.parts.push_back({source});
    solver.parts.back().errors.fill(source == ErrorSource::solver ? 2e-3 : 1e-3);
  }
  EXPECT_TRUE(contains(cli::error_sentence(solver, 0.5),
                       "most of it due to the solver; a smaller solver.newton_tolerance reduces"));
}

TEST(Companions, TellTheErrorOfTheMeshWhereItsCellsCanBeHalved) {
  const std::vector<std::string> exact{"time.integrator=bdf2", "time.step=0.0025", "solver.newton_tolerance=1e-3"};
  scene::Scene scene = swinging(exact);
  const double estimated = part_of(estimate_of(scene, {.mesh = true}), ErrorSource::mesh);
  // The estimate is compared with the difference from a mesh with cells of a quarter of the size. The error of this
  // mesh is a sixteenth.
  scene::Scene twice = scene, four_times = scene;
  refine(twice, 2);
  refine(four_times, 4);
  std::vector<std::size_t> same = matching_particles_in_refined(scene);
  const std::vector<std::size_t> next = matching_particles_in_refined(twice);
  for (std::size_t& particle : same) particle = next[particle];
  const double is = at(compare(follow(scene), follow(four_times), same), Quantity::position);
  EXPECT_GT(estimated, is / 3);
  EXPECT_LT(estimated, is * 3);

  scene = swinging({"cloth.sheet.particles=6"});
  const ErrorEstimate odd = estimate_of(scene, {.mesh = true});
  EXPECT_EQ(odd.parts.back().source, ErrorSource::mesh);
  EXPECT_EQ(odd.parts.back().missing, "the cells cannot be halved");
  EXPECT_TRUE(contains(cli::error_summary(odd), "mesh not known: the cells cannot be halved"));
}

TEST(Companions, KnowNoErrorOfTheMeshAndNoShadowOfRopes) {
  const scene::Scene scene = support::scene_of_text(
      "[time]\nduration = 0.08\n[[rope]]\nname = \"r\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ndiameter = 0.02\n");
  const ErrorEstimate estimate = estimate_of(scene, {.mesh = true});
  EXPECT_EQ(estimate.parts.back().missing, "the cells cannot be halved");
  EXPECT_EQ(at(estimate.all, Quantity::shadow), 0);
}

TEST(Companions, NeedClothOrRopes) {
  const scene::Scene scene =
      support::scene_of_text("[time]\nduration = 0.08\n[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nmass = 1\n");
  EXPECT_THROW(estimate_of(scene), Error);
}

// A strip that stands on its edge and may fall to either side.
scene::Scene undecided() {
  return support::scene_of_text(
      "[time]\nduration = 0.8\n[[cloth]]\nname = \"a\"\nsize = [0.2, 0.3]\nparticles = [5, 7]\nstart_noise = 1e-7\n"
      "position = [0, 0, 0.153]\nrotation = [90, 0, 0]\n[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\n");
}

TEST(Companions, ReportChaoticMotion) {
  const ErrorEstimate estimate = estimate_of(undecided());
  EXPECT_TRUE(estimate.is_chaotic);
  EXPECT_GT(part_of(estimate, ErrorSource::start), 1e-4);
  const std::string text = cli::error_sentence(estimate, 0.3);
  EXPECT_TRUE(contains(text, "the motion is chaotic: a start moved by 1 µm alone moves positions by")) << text;
  EXPECT_FALSE(cli::error_json(estimate).at("comparable"));
}

TEST(Companions, ReportALowerBoundIfAPartOfTheErrorIsNotKnown) {
  ErrorEstimate estimate;
  estimate.parts = {{ErrorSource::steps, {}}, {ErrorSource::mesh, {}, "the coarser mesh touches a body"}};
  EXPECT_TRUE(estimate.is_lower_bound());
  const std::string text = cli::error_sentence(estimate, 0.3);
  EXPECT_TRUE(contains(text, "positions are off by at least")) << text;
  EXPECT_TRUE(contains(text, "the error due to the mesh is not known")) << text;
  estimate.parts[1].missing.clear();
  EXPECT_FALSE(estimate.is_lower_bound());
}

// Without contact, BDF2 shows its second order: the changes by half and by twice the step have the expected ratio.
// Three cases: steps of 5 ms, which divide a frame evenly (with 10 ms, the order would just not be recognised); steps
// of 8 ms, of which the double does not divide a frame evenly; steps that time.tolerance chooses.
TEST(Companions, ObserveTheOrder) {
  for (const char* steps : {"time.step=0.005", "time.step=0.008", "time.tolerance=1e-5"}) {
    const scene::Scene scene = swinging({"time.integrator=bdf2", steps});
    const Trajectory run = follow(scene);
    const ErrorEstimate estimate = estimate_error(scene, run);
    EXPECT_FALSE(estimate.is_lower_bound()) << steps;
    // Measured ratios of estimate and true error: 1.42, 1.30 and 1.10.
    const double ratio = at(estimate.all, Quantity::position) / at(compare(run, truth()), Quantity::position);
    EXPECT_GT(ratio, 0.67) << steps;
    EXPECT_LT(ratio, 1.6) << steps;
  }
}

TEST(Companions, WarnOfStepsWhoseErrorDoesNotFall) {
  // A stiff sheet bounces off a floor: doubling the step changes the result hardly more than halving it.
  const scene::Scene bounces = support::scene_of_text(
      "[time]\nduration = 0.48\nintegrator = \"bdf2\"\n[[cloth]]\nname = \"a\"\nsize = 0.4\nparticles = 9\n"
      "position = [0, 0, 0.2]\nrotation = [20, 10, 0]\nmaterial = { stretch = 200, shear = 60, bend = 3e-3, "
      "stretch_viscosity = 0.2, shear_viscosity = 0.1, bend_friction = 0 }\n"
      "[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\n");
  // With twice the step the midpoint rule gains energy on a stiff sheet, and that run is refused.
  scene::Scene fails = swinging({"time.integrator=implicit_midpoint", "time.step=0.02"});
  fails.cloths[0].material.stretch_weft = fails.cloths[0].material.stretch_warp = 1e5;
  for (const scene::Scene& scene : {bounces, fails}) {
    const ErrorEstimate estimate = estimate_of(scene);
    EXPECT_TRUE(estimate.steps_irregular);
    EXPECT_TRUE(contains(cli::error_sentence(estimate, 0), "steps twice as long fail or change it hardly more"));
  }
}

TEST(Companions, StopOnRequest) {
  EXPECT_THROW(estimate_of(swinging(), {.proceed = [] { return false; }}), Error);
}

class ErrorOfARun : public support::TestFolder {};

TEST_F(ErrorOfARun, IsReportedAtTheEndAndInTheStatistics) {
  support::write_bytes(folder_ / "s.toml", kSwingingSheet);
  const cli::Outcome outcome = cli::run_weft({"simulate", "s.toml", "--cache", "c", "--error", "--stats", "s.json",
                                              "--set", "cloth.sheet.particles=9", "--set", "time.duration=0.4"},
                                             folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "error              positions ")) << outcome.err;
  const auto error = nlohmann::json::parse(support::read_bytes(folder_ / "s.json")).at("error");
  const ErrorEstimate expected = estimate_of(swinging());
  EXPECT_DOUBLE_EQ(error.at("all").at("position_m"), at(expected.all, Quantity::position));
  EXPECT_DOUBLE_EQ(error.at("parts").at("solver").at("position_m"), part_of(expected, ErrorSource::solver));
  EXPECT_FALSE(error.at("parts").contains("mesh"));
}

}  // namespace
}  // namespace weft::bench
