// Stability limits of a user's scene: the program varies the values of the scene, and states the margin in one
// sentence.
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/subprocess.hpp"
#include "lab/bench/scene_stability_report.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::bench {
namespace {

using cli::contains;

/// A strip of undamped threads that swings from one edge with the midpoint rule. It becomes unstable with long steps or
/// stiff threads.
const std::string kStrip =
    "[time]\nduration = 0.8\nfps = 10\nstep = 0.00625\nintegrator = \"implicit_midpoint\"\n[physics]\nair_density = 0\n"
    "[contact]\nself = false\nobstacles = false\n[[cloth]]\nname = \"strip\"\nsize = [0.3, 0.3]\nparticles = [5, 5]\n"
    "position = [0, 0, 1]\nmaterial = { density = 0.2, stretch = 1000, shear = 100, bend = 1e-5, bend_viscosity = 0, "
    "bend_friction = 0, drag = 0, max_stretch = 0 }\n[[cloth.pin]]\nlow = [0, 1]\nhigh = [1, 1]\n";

Factors with(VariedParameter value, double factor) {
  Factors factors{1, 1, 1, 1, 1, 1};
  factors[static_cast<std::size_t>(value)] = factor;
  return factors;
}

const SceneStability& strip() {
  static const SceneStability kStability = measure_scene_stability(support::scene_of_text(kStrip));
  return kStability;
}

TEST(SceneStability, TriesEachValueThatTheSceneHas) {
  EXPECT_EQ(strip().as_is.verdict, TrialVerdict::holds) << strip().as_is.reason;
  EXPECT_EQ(strip().frames, 8);
  for (const VariedParameter value :
       {VariedParameter::stiffness, VariedParameter::step, VariedParameter::mass, VariedParameter::mesh})
    for (const double factor : factors_of(value))
      EXPECT_NE(strip().find(with(value, factor)), nullptr) << name_of(value) << " " << factor;
  // The strip has neither contact nor damping, so neither is varied.
  for (const VariedParameter value : {VariedParameter::friction, VariedParameter::damping})
    EXPECT_EQ(strip().find(with(value, 2)), nullptr) << name_of(value);
  for (const double stiffness : kMapStiffness)
    for (const double step : kMapSteps) EXPECT_NE(strip().find({stiffness, step, 1, 1, 1, 1}), nullptr);
  const Trial* fine = strip().find(with(VariedParameter::mesh, 2));
  EXPECT_GT(fine->cpu_s, 0);
  EXPECT_DOUBLE_EQ(strip().find(with(VariedParameter::step, 4))->step, 0.025);
  EXPECT_DOUBLE_EQ(strip().find(with(VariedParameter::step, 8))->step, 0.05);
}

TEST(SceneStability, VariesTheFrictionOfObstaclesToo) {
  const SceneStability stability = measure_scene_stability(support::scene_of_text(
      kStrip + "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nposition = [5, 0, 0]\nfriction = 0.3\n",
      {"time.duration=0.1", "contact.obstacles=true", "cloth.strip.material.friction=0"}));
  for (const double factor : factors_of(VariedParameter::friction))
    EXPECT_NE(stability.find(with(VariedParameter::friction, factor)), nullptr) << factor;
}

// A heavier rope that hangs by its ends stretches more, a stiffer one less.
TEST(SceneStability, VariesRopesToo) {
  const SceneStability stability = measure_scene_stability(support::scene_of_text(
      "[time]\nduration = 0.1\nfps = 10\nstep = 0.05\n[contact]\nself = false\n[[rope]]\nname = \"line\"\n"
      "from = [0, 0, 0]\nto = [1, 0, 0]\nsegments = 4\nstretch = 1000\ndrag = 0\npin = [{ at = 0 }, { at = 1 }]\n"));
  for (const VariedParameter value : {VariedParameter::stiffness, VariedParameter::mass, VariedParameter::damping})
    ASSERT_NE(stability.find(with(value, 10)), nullptr) << name_of(value);
  EXPECT_GT(stability.find(with(VariedParameter::mass, 10))->max_strain, stability.as_is.max_strain);
  EXPECT_LT(stability.find(with(VariedParameter::stiffness, 10))->max_strain, stability.as_is.max_strain);
}

TEST(SceneStability, FindsWhereItBreaksAndWhatBreaks) {
  const auto margins = margins_of(strip());
  const auto stiffer = std::ranges::find_if(margins, [](const Margin& margin) {
    return margin.axis == VariedParameter::stiffness && margin.breaks != nullptr && margin.breaks->factors[0] > 1;
  });
  ASSERT_NE(stiffer, margins.end());
  // A run with this factor must end with the same message.
  scene::Scene scene = support::scene_of_text(kStrip);
  scene::Material& material = scene.cloths[0].material;
  for (double* stiffness : {&material.stretch_weft, &material.stretch_warp, &material.shear, &material.bend})
    *stiffness *= stiffer->breaks->factors[0];
  production::SceneSimulation simulation(scene);
  std::string reported;
  try {
    for (int k = 0; k < 8; ++k)
      for (const std::string& warning : simulation.advance().warnings) reported += warning;
  } catch (const Error& error) {
    reported += error.what();
  }
  EXPECT_TRUE(contains(reported, "more than at the start")) << reported;
  const std::string sentence = margin_sentence(strip());
  EXPECT_TRUE(sentence.starts_with("The scene as it is runs without anything broken, and its nearest limit is "))
      << sentence;
  EXPECT_TRUE(contains(sentence, "breaks at")) << sentence;
}

TEST(SceneStability, ASceneThatBreaksSaysWhatHolds) {
  SceneStability stability;
  stability.as_is = {.verdict = TrialVerdict::refused, .reason = "why", .step = 0.01};
  stability.trials.push_back({.factors = with(VariedParameter::step, 0.125), .is_free_of_faults = true});
  stability.trials.push_back({.factors = with(VariedParameter::step, 0.5), .is_free_of_faults = true});
  stability.trials.push_back({.factors = with(VariedParameter::mass, 10), .verdict = TrialVerdict::warned});
  // The trial with more friction is not free of faults, like the scene itself.
  stability.trials.push_back({.factors = with(VariedParameter::friction, 1.5)});
  EXPECT_EQ(margin_sentence(stability), "The scene as it is breaks (refused: why); it goes through with step at 5 ms.");
}

TEST(SceneStability, MarginIsUpToTheFirstThatBreaks) {
  SceneStability stability;
  stability.as_is.step = 0.01;
  stability.trials.push_back({.factors = with(VariedParameter::step, 2)});
  stability.trials.push_back({.factors = with(VariedParameter::step, 4),
                              .verdict = TrialVerdict::warned,
                              .new_faults = {"energy comes from nowhere"}});
  stability.trials.push_back({.factors = with(VariedParameter::step, 8)});
  stability.trials.push_back(
      {.factors = with(VariedParameter::mass, 100), .verdict = TrialVerdict::refused, .reason = "why"});
  EXPECT_EQ(
      margin_sentence(stability),
      "The scene as it is runs without anything broken, and its nearest limit is step: it holds at 20 ms and breaks "
      "at 40 ms (warned of: energy comes from nowhere).");
  const Table table = margin_table(stability);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[1],
            (std::vector<std::string>{"step", "more", "20 ms", "40 ms", "warned of", "energy comes from nowhere"}));
  const std::string svg = trial_svg("a < b", stability);
  EXPECT_TRUE(contains(svg, "a &lt; b"));
  EXPECT_FALSE(contains(svg, "a < b"));
}

class BenchStability : public support::TestFolder {};

TEST_F(BenchStability, ReportsASceneOfTheUser) {
  support::write_bytes(folder_ / "s.toml", kStrip);
  const cli::Outcome outcome =
      cli::run_weft({"bench", "stability", "s.toml", "--set", "time.duration=0.2", "-o", "b"}, folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("The scene as it is runs without anything broken")) << outcome.out;
  const std::string page = support::read_bytes(folder_ / "b/stability_s.md");
  EXPECT_TRUE(contains(page, outcome.out.substr(0, outcome.out.find('\n'))));
  const std::string csv = support::read_bytes(folder_ / "b/stability_s.csv");
  EXPECT_TRUE(csv.starts_with("stiffness,step,mass,friction,damping,mesh,step_s,verdict,")) << csv;
  EXPECT_TRUE(support::read_bytes(folder_ / "b/stability_s.svg").starts_with("<svg "));
  // Existing files are kept.
  EXPECT_EQ(cli::run_weft({"bench", "stability", "s.toml", "-o", "b"}, folder_).exit_code, 6);
}

TEST_F(BenchStability, RefusesValuesForTheBuiltInScenesAndBrokenScenes) {
  EXPECT_EQ(cli::run_weft({"bench", "stability", "--set", "time.step=1"}, folder_).exit_code, 2);
  support::write_bytes(folder_ / "s.toml", "[time]\nduration = 1\nstep = -1\n");
  EXPECT_EQ(cli::run_weft({"bench", "stability", "s.toml"}, folder_).exit_code, 3);
}

}  // namespace
}  // namespace weft::bench
