// Cost of runs: settings, exponents and sentences from rows, and the command.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <map>
#include <regex>
#include <sstream>

#include "cli/subprocess.hpp"
#include "core/archive.hpp"
#include "core/parallel.hpp"
#include "lab/bench/html.hpp"
#include "lab/bench/speed_report.hpp"
#include "physics/mesh/ply.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::bench {
namespace {

using cli::contains;

// Made-up costs of 4 frames. With the number n of particles, forces grow as n, the linear solver as n^1.5.
SpeedRun run_with(double size, int threads, double step) {
  SpeedRun run{.setting = {size, threads, step}};
  run.particles = std::lround(10'000 * size * size);
  run.full_blocks = 9 * run.particles;
  run.isotropic_blocks = 4 * run.particles;
  run.frames = 4;
  run.steps = 16;
  run.newton_iterations = 48;
  run.linear_iterations = std::lround(480 * size);
  const auto n = static_cast<double>(run.particles);
  run.at(SpeedStage::forces) = {n * 1e-5 / threads / step, n * 1e-5 / step};
  run.at(SpeedStage::linear) = {std::pow(n, 1.5) * 1e-6 / threads / step, std::pow(n, 1.5) * 1e-6 / step};
  run.memory_before = 10'000'000;
  run.peak_memory = run.memory_before + 2000 * run.particles;
  run.bandwidth = 1e10;
  run.positions = 7 + static_cast<std::uint64_t>(100 * size);
  return run;
}

std::vector<SpeedRun> rows() {
  std::vector<SpeedRun> runs;
  for (const SpeedSetting& setting : speed_settings({0.5, 1, 2}, {1, 2}, {0.5, 1, 2}))
    runs.push_back(run_with(setting.size, setting.threads, setting.step));
  return runs;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line + ",");
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

// Reads the rows of a CSV text, with the names of the header as keys.
std::vector<std::map<std::string, std::string>> records_of(const std::string& csv) {
  std::istringstream text(csv);
  std::string line;
  std::getline(text, line);
  const auto names = fields_of(line);
  std::vector<std::map<std::string, std::string>> records;
  while (std::getline(text, line)) {
    const auto fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    for (std::size_t i = 0; i < std::min(names.size(), fields.size()); ++i) {
      if (i == 0) records.emplace_back();
      records.back()[names[i]] = fields[i];
    }
  }
  return records;
}

TEST(SpeedSettings, AreAllSizesWithAllThreadsAndStepsAtTheSizeOfTheScene) {
  const auto settings = speed_settings({0.5, 1.25, 4}, {1, 3}, {0.5, 1});
  ASSERT_EQ(settings.size(), 7u);
  std::vector<double> stepped;
  for (const SpeedSetting& s : settings)
    if (s.step != 1) stepped.insert(stepped.end(), {s.size, static_cast<double>(s.threads), s.step});
  EXPECT_EQ(stepped, (std::vector<double>{1.25, 1, 0.5}));
  EXPECT_GT(expected_work({2, 1, 1}), expected_work({1, 1, 0.5}));
  EXPECT_GT(expected_work({1, 1, 1}), expected_work({1, 2, 1}));
}

TEST(SpeedSettings, ScaleParticlesOfRectanglesAndTheStep) {
  const char* const kTwo =
      "[[cloth]]\nname = 'a'\nparticles = [64, 31]\n[[cloth]]\nname = 'b'\nparticles = [3, 2]\nposition = [0, 0, 5]\n";
  const auto scene = support::scene_of_text(kTwo, {"time.step=0.01"});
  EXPECT_TRUE(has_sizes(scene));
  EXPECT_TRUE(overrides_of(scene, {1, 2, 1}).empty());
  EXPECT_EQ(overrides_of(scene, {0.5, 1, 2}),
            (std::vector<std::string>{"cloth.0.particles=[32,16]", "cloth.1.particles=[2,2]", "time.step=0.02"}));
  const auto controlled = support::scene_of_text(kTwo, {"time.tolerance=0.001"});
  EXPECT_EQ(overrides_of(controlled, {1, 1, 0.5}), std::vector<std::string>{"time.tolerance=0.0005"});
}

TEST(SpeedReport, SeriesDifferInOneThingAndLeaveFailuresOut) {
  auto runs = rows();
  runs.push_back({.setting = {4, 1, 1}, .failure = "no memory"});
  const auto sizes = over_sizes(runs);
  ASSERT_EQ(sizes.size(), 3u);
  EXPECT_EQ(sizes.back()->setting.size, 2);
  EXPECT_EQ(sizes.back()->setting.threads, 1);
  ASSERT_EQ(over_threads(runs, 2).size(), 2u);
  EXPECT_EQ(over_threads(runs, 2).back()->setting.threads, 2);
  const auto steps = over_steps(runs);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps.front()->setting.step, 2);
  EXPECT_EQ(steps[1]->setting.size, 1);
  const std::string text = speed_markdown({"t", "m", {}, runs}, "p.svg");
  EXPECT_TRUE(contains(text, "## Runs that failed")) << text;
  EXPECT_TRUE(contains(text, "no memory")) << text;
}

TEST(SpeedReport, LinksToPlotsWhateverTheNameOfTheScene) {
  const std::string name = "speed_a (1) 50%.svg", text = speed_markdown({"t", "m", {}, rows()}, name);
  EXPECT_TRUE(contains(text, "![By particles](speed_a%20%281%29%2050%25.svg)\n")) << text;
  const std::string page = html_page("t", text, [&](const std::string& link) {
    EXPECT_EQ(link, link_to(name));
    return "<svg/>";
  });
  EXPECT_TRUE(contains(page, "<svg/>")) << page;
}

TEST(SpeedReport, ExponentsAreSlopesBetweenSizes) {
  const SpeedRun small = run_with(1, 1, 1), large = run_with(2, 1, 1);
  EXPECT_NEAR(*exponent(small, large, 3, 12), 1, 1e-12);
  EXPECT_NEAR(*exponent(small, large, 3, 96), 2.5, 1e-12);
  EXPECT_FALSE(exponent(large, small, 3, 96));
  EXPECT_FALSE(exponent(small, large, 0, 96));
  const std::string text = speed_markdown({"t", "m", {}, rows()}, "p.svg");
  // With 40,000 particles, forces cost 0.4 CPU s and the linear solver 8 CPU s, in 4 frames.
  EXPECT_TRUE(contains(text, "| 40,000 | 16 | 0 | 3.00 | 20.0 (0.50) | 100 (1.00) | 2,000 (1.50) | 2,100 (1.47) |"))
      << text;
}

TEST(SpeedReport, ConclusionIsComputedFromTheRows) {
  auto runs = rows();
  const std::string text = conclusion(runs);
  // 40,000 particles cost 2.1 s a frame, 2,500 particles 37.5 ms: the exponent is log 56 / log 16; from 10,000
  // particles on, it is log 7.64 / log 4.
  EXPECT_TRUE(contains(text,
                       "A frame takes 2,100 CPU ms with 40,000 particles. The largest part of that is linear "
                       "solver, 95 %. From 2,500 particles, with 37.5 CPU ms, it grows with the power 1.45 of "
                       "the particles, in the end 1.47."))
      << text;
  EXPECT_TRUE(contains(text, "2 threads are 2.00 times as fast with 2,500 particles, ")) << text;
  EXPECT_TRUE(contains(text, "; the results are the same bits with any number.")) << text;
  EXPECT_TRUE(contains(text, "40,000 particles take 90 MB, 2 kB each.")) << text;
  runs[1].positions = 0;
  EXPECT_TRUE(contains(conclusion(runs), "the results are NOT the same bits")) << conclusion(runs);
  runs = {run_with(1, 1, 1)};
  EXPECT_TRUE(contains(conclusion(runs), "A frame takes 275 CPU ms with 10,000 particles. The largest"))
      << conclusion(runs);
  runs = {{.setting = {1, 1, 1}, .failure = "why"}};
  EXPECT_EQ(conclusion(runs), "No run succeeded.\n");
}

TEST(SpeedReport, BoundIsWhatMovesOverTheBandwidth) {
  SpeedRun run = run_with(1, 1, 1);
  // Counted by hand. A full block has 9 numbers and a column index, an isotropic block a number and a column index,
  // of 4 bytes each. Each particle has 16 padded vectors of 16 bytes.
  EXPECT_EQ(bytes_of_linear_iteration(run), 10'000 * (9 * 40 + 4 * 8 + 16 * 16));
  // Each number is moved three times in double and once in single precision; three evaluations move three vectors each.
  EXPECT_EQ(bytes_of_newton_iteration(run), 10'000 * (9 * 9 * 28 + 4 * 28 + 9 * 24));
  EXPECT_NEAR(memory_bound_s(run), (480 * 6.48e6 + 48 * 2.596e7) / 1e10, 1e-12);
  EXPECT_EQ(run.bytes_a_particle(), 2000);
  run.bandwidth = 0;
  EXPECT_EQ(memory_bound_s(run), 0) << "not known";
  // Limits [bytes/s]: the bandwidth of memory is above that of a disk and below that of registers.
  EXPECT_GT(read_bandwidth(1e5), 1e8);
  EXPECT_LT(read_bandwidth(1e5), 1e13);
}

TEST(SpeedReport, LoopsBoundWhatThreadsGain) {
  SpeedRun run = run_with(1, 1, 1);
  const double wall = run.all().wall_s;
  run.loops = {.loops = 10, .chunks = 40, .seconds = 0.75 * wall, .seconds_on = {}};
  run.loops.seconds_on = {0.4 * wall, 0.25 * wall, 0.15 * wall, 0};
  EXPECT_NEAR(run.serial_fraction(), 0.25, 1e-12);
  EXPECT_NEAR(run.largest_gain(1), 2, 1e-12);
  EXPECT_NEAR(run.largest_gain(3), 4, 1e-12);
  const std::string report = speed_markdown({"drape", "a machine", {1, 2}, {run}}, "plot.svg");
  EXPECT_TRUE(contains(report, "## What threads can gain")) << report;
  EXPECT_TRUE(contains(report, " 25.0 % |")) << report;
  EXPECT_TRUE(contains(report, " 1.5 | 2.0 | 2.5 | 4.0 |")) << report;
}

TEST(SpeedReport, RunsAreSentWhole) {
  SpeedRun run = run_with(2, 3, 0.5);
  run.loops = {.loops = 10, .chunks = 40, .seconds = 1, .seconds_on = {}};
  run.failure = "why";
  ByteWriter writer;
  serialize(writer, run);
  SpeedRun back;
  ByteReader reader{writer.bytes};
  serialize(reader, back);
  EXPECT_TRUE(reader.bytes.empty());
  EXPECT_EQ(csv(speed_table({run})), csv(speed_table({back})));
  run.failure = back.failure = "";
  EXPECT_EQ(csv(speed_table({run})), csv(speed_table({back})));
}

TEST(SpeedReport, StagesOfARunAddUpToIt) {
  const auto scene = support::scene_of_text(kSphereDrape, {"cloth.0.particles=[12,12]"});
  const WallTimer timer;
  const SpeedRun run = run_for_speed(scene, {1, 1, 1}, {3, 5});
  const double all = timer.seconds();
  EXPECT_EQ(run.frames, 2);
  EXPECT_EQ(run.particles, 144);
  EXPECT_GE(run.full_blocks, 144 + 4 * 11 * 12) << "particles and threads, both ways";
  for (std::size_t s = 0; s + 1 < kSpeedStages; ++s) EXPECT_GT(run.stages[s].wall_s, 0) << s;
  EXPECT_EQ(run.at(SpeedStage::drawing).wall_s, 0);
  EXPECT_LT(run.all().wall_s, all);
  EXPECT_GE(run.newton_iterations, run.steps);
  EXPECT_GT(run.peak_memory, run.memory_before);
  stopwatch_includes_all_threads = false;
  set_thread_count(0);
}

class BenchSpeed : public support::TestFolder {
 protected:
  // Writes a shell script that can be started.
  void write_peer(const std::string& commands) const {
    support::write_bytes(folder_ / "peer", "#!/bin/sh\n" + commands);
    std::filesystem::permissions(folder_ / "peer", std::filesystem::perms::owner_all);
  }
  cli::Outcome run_beside_peer() const {
    return cli::run_weft({"bench", "speed", "--sizes", "0.1", "--threads", "1", "--steps", "1", "--frames", "1:2",
                          "--set", "time.step=0.02", "--peer", "peer", "-o", "b"},
                         folder_);
  }
  std::string read_report() const { return support::read_bytes(folder_ / "b" / "speed_sphere_drape.md"); }
};

TEST_F(BenchSpeed, WritesReportTableAndPlot) {
  const cli::Outcome outcome = cli::run_weft(
      {"bench", "speed", "--sizes", "0.2,0.1", "--threads", "1,2", "--steps", "2", "--frames", "1:2", "-o", "b"},
      folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "A frame takes ")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "speed: 100 %, size 0.2, 1 thread, step 2: 169 particles")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, " left")) << outcome.err;
  const auto records = records_of(support::read_bytes(folder_ / "b" / "speed_sphere_drape.csv"));
  ASSERT_EQ(records.size(), 5u);
  for (auto record : records) {
    const int particles = record["size"] == "0.1" ? 36 : 169;  // 64 particles per unit of size, rounded
    EXPECT_EQ(record["particles"], std::to_string(particles));
    EXPECT_EQ(record["frames"], "1");
    EXPECT_EQ(record["steps"], record["step"] == "2" ? "2" : "4");
    double sum = 0;
    for (const char* stage : {"forces", "preconditioner", "linear_solver", "collisions", "rest", "drawing"})
      sum += std::stod(record[std::string(stage) + "_wall_ms"]);
    // Tolerance: the file has six significant digits.
    EXPECT_NEAR(sum, std::stod(record["all_wall_ms"]), 1e-4 * sum);
    EXPECT_GT(std::stod(record["bandwidth_bytes_a_s"]), 0);
    EXPECT_GT(std::stod(record["peak_memory_bytes"]), 1e6);
    EXPECT_EQ(record["failure"], "");
  }
  EXPECT_EQ(records[0].at("last_positions"), records[1].at("last_positions")) << "on one thread and on two";
  EXPECT_NE(records[0].at("last_positions"), records[2].at("last_positions"));
  const std::string svg = support::read_bytes(folder_ / "b" / "speed_sphere_drape.svg");
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
  const std::string report = support::read_bytes(folder_ / "b" / "speed_sphere_drape.md");
  for (const char* part : {"speed_sphere_drape.svg", "## Sizes", "## Threads", "## Steps", "## Memory", "## The bound"})
    EXPECT_TRUE(contains(report, part)) << part;
}

TEST_F(BenchSpeed, KeepsWhatWasMeasuredWhenItIsInterrupted) {
  // The second run would take minutes.
  cli::Subprocess bench(
      {"bench", "speed", "--sizes", "0.1,8", "--threads", "1", "--frames", "1:40", "--steps", "1", "-o", "b"}, folder_);
  ASSERT_TRUE(bench.wait_for_output("36 particles"));
  bench.send(SIGINT);
  expect_exit(bench.wait(), 75, "interrupted after 1 of 2 runs");
  EXPECT_EQ(records_of(support::read_bytes(folder_ / "b" / "speed_sphere_drape.csv")).size(), 1u);
  EXPECT_TRUE(contains(support::read_bytes(folder_ / "b" / "speed_sphere_drape.md"), "## Sizes"));
}

TEST_F(BenchSpeed, ARunThatFailsIsARow) {
  support::write_bytes(folder_ / "s.toml", "[[cloth]]\nname = 'c'\nshape = 'mesh'\nfile = 'c.obj'\n");
  support::write_bytes(folder_ / "c.obj", "v 0 0\n");
  const cli::Outcome outcome = cli::run_weft({"bench", "speed", "s.toml", "--threads", "1", "--steps", "1"}, folder_);
  expect_exit(outcome, 5, "measured at its own size");
  EXPECT_TRUE(contains(outcome.out, "No run succeeded.")) << outcome.out;
  const auto csv = support::read_bytes(folder_ / "output" / "bench" / "speed_s.csv");
  EXPECT_TRUE(contains(csv, "c.obj")) << csv;
}

TEST_F(BenchSpeed, ComparesCostAndPairsWithAPeer) {
  // The peer prints a cost and copies meshes, in which the sheet crosses the floor in frame 0 and not in frame 1.
  for (const int frame : {0, 1}) {
    const auto write = [&](const std::string& name, const std::vector<Vec3>& positions) {
      mesh::write_ply(folder_ / "meshes" / fmt::format("{}_{:05}.ply", name, frame), positions,
                      std::vector<std::array<Index, 3>>{{0, 1, 2}});
    };
    write("floor", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    write("sphere", {{0, 0, 9}, {1, 0, 9}, {0, 1, 9}});
    write("sheet", {{0.25, 0.25, frame - 0.5}, {0.25, 0.25, 1}, {0.5, 0.25, 1}});
  }
  write_peer(
      "echo \"$@\" >> calls\n"
      "for last; do :; done\n"
      "case \"$*\" in *--meshes*) cp meshes/* \"$last\";; esac\n"
      "echo '36 particles: 12.5 CPU ms a frame, 9 (median)'\n");
  const cli::Outcome outcome = run_beside_peer();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(read_report(), "## Beside peer\n\nFrames 1 to 1 ")) << read_report();
  const std::regex row(R"(\n\| 36 \| [0-9.]+ \| 12\.5 \| [0-9.]+ \| 0, 0 \| 1, 0 \|\n)");
  EXPECT_TRUE(std::regex_search(read_report(), row)) << read_report();
  const std::string calls = support::read_bytes(folder_ / "calls");
  const std::regex timed(
      R"(\S+/sphere_drape\.toml --end 2 --set time\.step=0\.02 --set cloth\.0\.particles=\[6,6\]\n)");
  EXPECT_EQ(std::distance(std::sregex_iterator(calls.begin(), calls.end(), timed), std::sregex_iterator()), 3) << calls;
  EXPECT_EQ(std::ranges::count(calls, '\n'), 4) << "one more writes meshes: " << calls;
  const std::filesystem::directory_iterator left(folder_ / "b");
  EXPECT_EQ(std::distance(begin(left), end(left)), 3) << "report, table and plot";
}

TEST_F(BenchSpeed, APeerThatFailsIsARow) {
  write_peer("echo 12.5 ms\n");
  EXPECT_EQ(run_beside_peer().exit_code, 5);
  EXPECT_TRUE(contains(read_report(), "expected its cost, such as \"12.3 CPU ms a frame\", got \"12.5 ms\""))
      << read_report();
  EXPECT_FALSE(contains(read_report(), "## Beside")) << read_report();
  std::filesystem::remove_all(folder_ / "b");
  write_peer("exit 3\n");
  EXPECT_EQ(run_beside_peer().exit_code, 5);
  EXPECT_TRUE(contains(read_report(), "/peer ended with exit code 3 |")) << read_report();
}

TEST_F(BenchSpeed, MistakesShowBeforeAnythingIsMeasured) {
  expect_exit(cli::run_weft({"bench", "speed", "--sizes", "0.1,50", "-o", "b"}, folder_), 3,
              "cloth.sheet.particles: expected");
  expect_exit(cli::run_weft({"bench", "speed", "--frames", "70:90", "-o", "b"}, folder_), 2,
              "expected a range within 0:76");
  expect_exit(cli::run_weft({"bench", "speed", "--set", "time.duration=0", "-o", "b"}, folder_), 3,
              "expected at least one frame after frame 0");
  expect_exit(cli::run_weft({"bench", "speed", "--peer", "none", "-o", "b"}, folder_), 2,
              "--peer: expected a program that can be started");
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace weft::bench
