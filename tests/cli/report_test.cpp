// Statistics and summary of made-up runs.
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <sstream>

#include "support/test_folder.hpp"
#include "tools/cli/stats.hpp"
#include "tools/cli/summary.hpp"

namespace weft::cli {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Frame 0, and a frame that took 20 ms to simulate, of which 5 ms for collisions.
std::vector<FrameRecord> two_frames() {
  std::vector<FrameRecord> frames(2);
  frames[0].report.min_distance = kInfinity;
  simulation::FrameReport& report = frames[1].report;
  report.frame = 1;
  report.time = 0.04;
  report.simulate.wall_s = 0.020;
  report.simulate.cpu_s = 0.018;
  report.collide.wall_s = 0.005;
  report.steps = 4;
  report.error_estimate = 0.00123;
  report.solver_error = 0.0002;
  report.rejected_steps = 1;
  report.min_distance = 0.002;
  report.max_strain = 0.05;
  frames[1].written = true;
  frames[1].encode = {0.007, 0.006};
  return frames;
}

TEST(FrameJson, GivesMillisecondsAndNoInfinity) {
  const auto frames = two_frames();
  EXPECT_TRUE(frame_json(frames[0]).at("min_distance_m").is_null());
  const auto json = frame_json(frames[1]);
  EXPECT_DOUBLE_EQ(json.at("simulate_ms"), 20);
  EXPECT_DOUBLE_EQ(json.at("collide_ms"), 5);
  EXPECT_DOUBLE_EQ(json.at("encode_ms"), 7);
  EXPECT_DOUBLE_EQ(json.at("encode_cpu_ms"), 6);
  EXPECT_DOUBLE_EQ(json.at("min_distance_m"), 0.002);
  EXPECT_DOUBLE_EQ(json.at("error_estimate_m"), 0.00123);
  EXPECT_DOUBLE_EQ(json.at("solver_error_m"), 0.0002);
}

TEST(StatsJson, SumsUpSteps) {
  RunReport report;
  report.frames = two_frames();
  report.frames.back().report.inexact_steps = 3;
  report.frames.push_back(report.frames.back());
  EXPECT_EQ(frame_json(report.frames.back()).at("inexact_steps"), 3);
  const auto totals = stats_json(report).at("totals");
  EXPECT_EQ(totals.at("inexact_steps"), 6);
  EXPECT_EQ(totals.at("steps"), 8);
  EXPECT_EQ(totals.at("rejected_steps"), 2);
  EXPECT_DOUBLE_EQ(totals.at("error_estimate_m"), 0.00246);
  EXPECT_DOUBLE_EQ(totals.at("solver_error_m"), 0.0004);
}

// Returns the keys in the first column of the table that follows the text `before` in the page.
std::set<std::string> documented_keys(const std::string& page, const std::string& before) {
  std::set<std::string> keys;
  const std::size_t begin = page.find(before);
  if (begin == std::string::npos) return keys;
  const std::size_t table = page.find("|---|", begin), end = page.find("\n\n", table);
  std::istringstream lines(page.substr(table, end - table));
  for (std::string line; std::getline(lines, line);) {
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at + 1)) {
      const std::size_t close = cell.find('`', at + 1);
      keys.insert(cell.substr(at + 1, close - at - 1));
      at = close;
    }
  }
  return keys;
}

std::set<std::string> keys_of(const nlohmann::ordered_json& json) {
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  return keys;
}

TEST(StatsJson, EachKeyIsDocumented) {
  const std::string page = support::read_bytes(WEFT_SOURCE_DIR "/scenes/data.md");
  RunReport report;
  report.frames = two_frames();
  report.objects.push_back({"sheet", frame::ObjectKind::cloth, 4, 1});
  report.error.emplace().parts.push_back({run_error::ErrorSource::steps});
  const auto stats = stats_json(report);
  EXPECT_EQ(documented_keys(page, "## Keys of `--stats`"), keys_of(stats));
  EXPECT_EQ(documented_keys(page, "Keys of one of `objects`"), keys_of(stats.at("objects").at(0)));
  EXPECT_EQ(documented_keys(page, "Keys of `totals`"), keys_of(stats.at("totals")));
  EXPECT_EQ(documented_keys(page, "Keys of one of `frames`"), keys_of(stats.at("frames").at(1)));
  EXPECT_EQ(documented_keys(page, "Keys of `error`"), keys_of(stats.at("error")));
  EXPECT_EQ(documented_keys(page, "Keys of its `all`"), keys_of(stats.at("error").at("all")));
}

TEST(Summary, NamesTheFramesOfTheExtremes) {
  RunReport report;
  report.output = "a.mp4";
  report.frames = two_frames();
  report.written = 1;
  report.width = 64;
  report.height = 36;
  report.fps = 25;
  report.output_bytes = 1'234'567;
  const std::string text = summary(report);
  for (const char* part : {"a.mp4: 1 frame, 64x36 at 25 fps, 1.2 MB\n", "2 mm (frame 1)\n", "5.00 % (frame 1)\n",
                           "4 and 1 rejected;", "  simulate      0.02 s  0.02 s      18.0 ms\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  report.frames.erase(report.frames.begin());  // frames read from a cache may begin after frame 0
  EXPECT_NE(summary(report).find("  simulate      0.02 s  0.02 s      18.0 ms\n"), std::string::npos);
}

// The summary states the error of the worst frame. The sum over all frames is not useful: for example, 120 mm for a
// band of a metre.
TEST(Summary, SaysByWhatTheWorstFrameIsOffAndWhatReducesIt) {
  RunReport report;
  report.frames = two_frames();
  for (int k = 0; k < 100; ++k) report.frames.push_back(report.frames[1]);
  report.frames[7].report.frame = 7;
  report.frames[7].report.error_estimate = 0.005;
  report.cloth_size = 0.5;
  EXPECT_NE(summary(report).find("frame 7, the worst, adds about 5 mm (1 % of the cloth's size) to the error of "
                                 "positions, due to the time steps (the solver: 0.2 mm); a smaller time.step or "
                                 "time.tolerance reduces it; --error estimates that of the whole run\n"),
            std::string::npos)
      << summary(report);
  report.frames[7].report.solver_error = 0.01;
  EXPECT_NE(summary(report).find("adds about 10 mm (2 % of the cloth's size) to the error of positions, due to the "
                                 "solver (the time steps: 5 mm); a smaller solver.newton_tolerance reduces it"),
            std::string::npos)
      << summary(report);
  report.frames = {{}};
  EXPECT_NE(summary(report).find("no step was taken"), std::string::npos);
}

TEST(Summary, SaysWhatCompanionsHaveMeasured) {
  RunReport report;
  report.frames = two_frames();
  report.cloth_size = 2;
  run_error::ErrorPart steps{run_error::ErrorSource::steps}, start{run_error::ErrorSource::start};
  steps.errors[static_cast<std::size_t>(run_error::Quantity::position)] = 0.008;
  start.errors[static_cast<std::size_t>(run_error::Quantity::position)] = 1e-6;
  report.error = run_error::ErrorEstimate{.parts = {steps, start}, .all = steps.errors};
  EXPECT_NE(summary(report).find("positions may be off by 8 mm (0.4 % of the cloth's size), most of it due to the time "
                                 "steps; a smaller time.step or time.tolerance reduces it\n"),
            std::string::npos)
      << summary(report);
  EXPECT_EQ(summary(report).find("--error estimates"), std::string::npos);
  report.error->is_chaotic = true;
  EXPECT_NE(summary(report).find("the motion is chaotic"), std::string::npos);
}

TEST(Summary, OfARunWithoutFramesSaysSo) {
  RunReport report;
  report.output = "a.mp4";
  report.width = 64;  // a report without picture size is one of a run without pictures
  EXPECT_EQ(summary(report).substr(0, 31), "a.mp4: no frame was written\n   ");
}

TEST(Warnings, ComeOnlyWithFiguresThatLookWrong) {
  auto frames = two_frames();
  EXPECT_TRUE(find_warnings(frames).empty());  // one rejected step in five does not suffice for a warning
  frames[1].report.rejected_steps = 2;
  ASSERT_EQ(find_warnings(frames).size(), 1u);
  EXPECT_EQ(find_warnings(frames)[0],
            "2 of 6 steps failed and were repeated as shorter ones: a smaller time.step would be faster");
  frames[1].report.inexact_steps = 1;
  ASSERT_EQ(find_warnings(frames).size(), 2u);
  EXPECT_TRUE(
      find_warnings(frames)[1].starts_with("1 of 4 steps, most in frame 1, have an error above time.tolerance"));
  frames[1].report.inexact_steps = 0;
  frames[1].report.max_strain = 0.4;
  frames[1].report.min_distance = 0;
  EXPECT_EQ(find_warnings(frames).size(), 3u);
  EXPECT_TRUE(find_warnings({}).empty());
}

TEST(Warnings, NameTheFrameToLookAt) {
  auto frames = two_frames();
  simulation::FrameReport& report = frames[1].report;
  report.max_strain = 0.4;
  report.stretch_ratio = 1.8;
  report.pinched_pairs = report.lagging_particles = 3;
  report.min_distance = 0;
  frames.push_back(frames[1]);
  frames[2].report.frame = 2;
  frames[2].report.stretch_ratio = 2.1;
  const std::vector<std::string> warnings = find_warnings(frames);
  ASSERT_EQ(warnings.size(), 5u);
  EXPECT_NE(warnings[0].find("by up to 40 %, in frame 1:"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("in 2 of 3 frames, first in frame 1, most in frame 2, to 2.1 times that limit"),
            std::string::npos)
      << warnings[1];
  for (std::size_t k = 2; k < 5; ++k)
    EXPECT_NE(warnings[k].find("in 2 of 3 frames, first in frame 1"), std::string::npos) << warnings[k];
}

}  // namespace
}  // namespace weft::cli
