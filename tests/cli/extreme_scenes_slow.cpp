// Runs the scenes of `weft bench stability`: each ends with the expected verdict and leaves only complete files.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "cli/subprocess.hpp"
#include "cli/video_probe.hpp"
#include "lab/bench/stability.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

struct Trial {
  std::string name, text;
  int frames = 0;                      // maximum number of frames, including the start
  std::vector<std::string> overrides;  // KEY=VALUE
  double driven = 0;
  friend void PrintTo(const Trial& trial, std::ostream* out) { *out << trial.name; }
};

// The scenes of `weft bench stability`, shortened, and scenes whose options request too much.
std::vector<Trial> trials() {
  std::vector<Trial> trials;
  std::string hanging;
  for (const bench::ExtremeCase& extreme : bench::extreme_cases()) {
    const int max_frames = extreme.name == "many" ? 2 : extreme.name == "resting" ? 4 : 9;
    trials.push_back({extreme.name, extreme.text, std::min(max_frames, extreme.frames), {}, extreme.driven});
    if (extreme.name == "ratio_1e8") hanging = extreme.text;
  }
  trials.push_back({"no_iterations", hanging, 5, {"solver.newton_iterations=1", "solver.halvings=0"}, {}});
  trials.push_back({"stiff_midpoint",
                    hanging,
                    5,
                    {"time.integrator=implicit_midpoint", "cloth.sheet.material.stretch=1e8", "time.fps=5",
                     "time.step=0.2", "solver.halvings=2"},
                    {}});
  return trials;
}

class ExtremeScene : public support::TestFolder, public ::testing::WithParamInterface<Trial> {
 protected:
  Outcome run() const {
    const Trial& trial = GetParam();
    support::write_bytes(folder_ / "s.toml", trial.text);
    std::vector<std::string> arguments =
        joined({"run", "s.toml", "--frames", fmt::format("0:{}", trial.frames), "--stats", "stats.json"}, kSmall);
    for (const std::string& change : trial.overrides) arguments.insert(arguments.end(), {"--set", change});
    return run_weft(arguments, folder_);
  }

  std::set<std::string> tree() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder_).string());
    return names;
  }
};

TEST_P(ExtremeScene, EndsWithTheExitCodeOfItsVerdictAndWholeFiles) {
  const Trial& trial = GetParam();
  const bench::Outcome expected =
      bench::try_scene(support::scene_of_text(trial.text, trial.overrides), trial.frames - 1, trial.driven);
  // A run reports a spurious gain of energy as a warning, not by its exit code.
  ASSERT_NE(expected.verdict, bench::Verdict::not_finite);
  const bool refused = expected.verdict == bench::Verdict::refused;
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, refused ? 5 : 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  // A refused run leaves its working cache, if it was long enough to save its state. No other temporary file is left.
  // The video contains every finished frame.
  std::set<std::string> left = tree();
  if (refused) std::erase_if(left, [](const std::string& name) { return name.starts_with("output/.s.weft-cache/"); });
  EXPECT_EQ(left, (std::set<std::string>{"output/s.effective.toml", "output/s.mp4", "s.toml", "stats.json"}));
  EXPECT_EQ(probe_video(folder_ / "output/s.mp4").frames, expected.frames + 1);

  std::istringstream lines(outcome.err);
  int errors = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("weft:")) continue;
    ++errors;
    EXPECT_TRUE(contains(line, expected.reason)) << line;
  }
  EXPECT_EQ(errors, refused ? 1 : 0) << outcome.err;
}

TEST(ExtremeScenes, AskForTooMuchWhereTheyShould) {
  for (const Trial& trial : trials()) {
    if (trial.overrides.empty()) continue;
    const scene::Scene scene = support::scene_of_text(trial.text, trial.overrides);
    EXPECT_EQ(bench::try_scene(scene, trial.frames - 1).verdict, bench::Verdict::refused) << trial.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ExtremeScene, ::testing::ValuesIn(trials()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace weft::cli
