// weft sweep: the list of runs, and their results.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/cached_run.hpp"
#include "film/image/png.hpp"
#include "film/video/encoder.hpp"
#include "tools/cli/sweep_plan.hpp"
#include "tools/cli/sweep_report.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names(const std::vector<SweepRun>& runs) {
  std::vector<std::string> names;
  for (const SweepRun& run : runs) names.push_back(run.name);
  return names;
}

TEST(SweepPlan, ValuesArePartedByCommasOutsideOfBrackets) {
  EXPECT_EQ(parse_axis("a.b=1, 2,3").values, (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(parse_axis("w=[0,1],[2,3]").values, (std::vector<std::string>{"[0,1]", "[2,3]"}));
  EXPECT_EQ(parse_axis("m={fabric=\"a,b\",x=1},\"c,d\"").values,
            (std::vector<std::string>{"{fabric=\"a,b\",x=1}", "\"c,d\""}));
  support::expect_error(ExitCode::usage, "expected values such as a=1,2,3", [] { parse_axis("a=1,,2"); });
  support::expect_error(ExitCode::usage, "expected path.to.key=value", [] { parse_axis("a"); });
}

TEST(SweepPlan, HasAllCombinationsNamedByWhatDiffers) {
  const auto runs = plan_sweep({}, {{"cloth.a.bend", {"1e-6", "1e-5"}}, {"fps", {"25"}}, {"time.step", {"1", "2"}}});
  EXPECT_EQ(names(runs),
            (std::vector<std::string>{"bend=1e-6_step=1", "bend=1e-6_step=2", "bend=1e-5_step=1", "bend=1e-5_step=2"}));
  EXPECT_EQ(runs[1].changes, (Changes{{"cloth.a.bend", "1e-6"}, {"fps", "25"}, {"time.step", "2"}}));
}

TEST(SweepPlan, KeysThatEndAlikeAreToldApart) {
  EXPECT_EQ(names(plan_sweep({}, {{"cloth.a.bend", {"1", "2"}}, {"cloth.b.bend", {"3"}}})),
            (std::vector<std::string>{"bend=1", "bend=2"}));
  EXPECT_EQ(names(plan_sweep({}, {{"cloth.a.bend", {"1", "2"}}, {"cloth.b.bend", {"3", "4"}}})).front(),
            "a.bend=1_b.bend=3");
}

TEST(SweepPlan, NamesAreFileNamesOfTheirOwn) {
  const auto runs =
      plan_sweep({}, {{"k", {"[0, 1]", "{0,1}", "../a b", std::string(300, 'x'), std::string(301, 'x')}}});
  EXPECT_EQ(names(runs), (std::vector<std::string>{"k=0,1", "k=0,1~2", "k=..-ab", "k=" + std::string(118, 'x'),
                                                   "k=" + std::string(118, 'x') + "~2"}));
}

TEST(SweepPlan, NamesHaveNothingOfAPathFromAKey) {
  EXPECT_EQ(names(plan_sweep({}, {{"../a/b", {"1", "2"}}})), (std::vector<std::string>{"-a-b=1", "-a-b=2"}));
}

// The list has the maximum number of values. Names keep only the beginning of a value, which is the same for all, so
// they are numbered.
TEST(SweepPlan, NamesThatAreCutAlikeAreNumbered) {
  Axis axis{"k", {}};
  for (int i = 0; i < 10'000; ++i) axis.values.push_back(std::string(200, 'x') + std::to_string(i));
  const std::vector<std::string> all = names(plan_sweep({}, {axis}));
  EXPECT_EQ(all.back(), "k=" + std::string(118, 'x') + "~10000");
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), axis.values.size());
}

TEST(SweepPlan, WhatIsAskedForTwiceIsThereOnce) {
  EXPECT_EQ(plan_sweep({}, {{"k", {"1", "2", "1"}}}).size(), 2u);
  support::expect_error(ExitCode::usage, "k: expected its values once, in --set or in --list, got them twice", [] {
    plan_sweep({}, {{"k", {"1"}}, {"k", {"2"}}});
  });
  support::expect_error(ExitCode::usage, "at most 10000 runs", [] {
    plan_sweep({}, {{"a", std::vector<std::string>(101, "1")}, {"b", std::vector<std::string>(100, "1")}});
  });
}

class SweepList : public support::TestFolder {
 protected:
  std::vector<Changes> read(const std::string& name, const std::string& text) const {
    support::write_bytes(folder_ / name, text);
    return read_list(folder_ / name);
  }
};

TEST_F(SweepList, OfCsvAndTomlIsTheSame) {
  const std::vector<Changes> expected{{{"a.b", "1e-6"}, {"w", "[1, 2]"}}, {{"a.b", "2"}}};
  EXPECT_EQ(read("l.csv", "a.b, w\n1e-6,\"[1, 2]\"\n\n2,\n"), expected);
  EXPECT_EQ(read("l.toml", "[[run]]\na.b = 1e-6\nw = [1, 2]\n[[run]]\na.b = 2\n"),
            (std::vector<Changes>{{{"a.b", "1e-06"}, {"w", "[ 1, 2 ]"}}, {{"a.b", "2"}}}));
  EXPECT_EQ(names(plan_sweep(expected, {{"s", {"3", "4"}}})).front(), "b=1e-6_w=1,2_s=3");
}

TEST_F(SweepList, OfASpreadsheetHasTheKeysWithoutItsByteOrderMark) {
  const std::vector<Changes> expected{{{"a.b", "1"}}};
  EXPECT_EQ(read("l.csv",
                 "\xEF\xBB\xBF"
                 "a.b\r\n1\r\n"),
            expected);
  EXPECT_EQ(read("l.toml",
                 "\xEF\xBB\xBF"
                 "[[run]]\na.b = 1\n"),
            expected);
  support::expect_error(ExitCode::asset_unreadable,
                        "l.csv:1:1: expected UTF-8, got UTF-16; save the table as CSV UTF-8", [&] {
                          read("l.csv", std::string("\xFF\xFE"
                                                    "a\0",
                                                    4));
                        });
}

TEST_F(SweepList, QuotedValuesMayHaveLineFeeds) {
  EXPECT_EQ(read("l.csv", "size,\"title\"\r\n\"[1,\r\n 2]\",\"a \"\"b\"\"\n\nc\"\r\n3,\r\n"),
            (std::vector<Changes>{{{"size", "[1,\r\n 2]"}, {"title", "a \"b\"\n\nc"}}, {{"size", "3"}}}));
  support::expect_error(ExitCode::asset_unreadable, "l.csv:4: expected 2 values as in the first line, got 1",
                        [&] { read("l.csv", "a,b\n\"1\n\",2\n3\n"); });
  support::expect_error(ExitCode::asset_unreadable, "l.csv:3: expected a quote at the end of each quoted value",
                        [&] { read("l.csv", "a,b\n1,2\n\"3,4\n5,6\n"); });
}

TEST_F(SweepList, MistakesNameTheirLine) {
  support::expect_error(ExitCode::asset_unreadable, "l.csv:3: expected 2 values as in the first line, got 1",
                        [&] { read("l.csv", "a,b\n1,2\n3\n"); });
  support::expect_error(ExitCode::asset_unreadable, "l.toml:2:", [&] { read("l.toml", "[[run]]\na = = 1\n"); });
  support::expect_error(ExitCode::asset_unreadable, "expected a table [[run]]", [&] { read("l.toml", "a = 1\n"); });
  support::expect_error(ExitCode::asset_unreadable, "names no run", [&] { read("l.csv", "a,b\n"); });
}

SweepResult made_up_result() {
  SweepResult result;
  result.run.difference = {{"bend", "1e-6"}};
  result.stats = nlohmann::ordered_json::parse(
      R"({"totals":{"cpu":9,"simulate_cpu":2.5,"render_cpu":4.25,"rejected_steps":1,"error_estimate_m":5,"solver_error_m":6},
          "frames":[{"newton_iterations":3,"max_strain":0.02,"kinetic_energy_j":0.5},
                    {"newton_iterations":4,"max_strain":0.01,"kinetic_energy_j":0.25}]})");
  return result;
}

std::string cell_of(const bench::Table& table, const std::string& column) {
  const auto at = std::ranges::find(table[0], column);
  return at == table[0].end() ? "no such column" : table[1][static_cast<std::size_t>(at - table[0].begin())];
}

TEST(SweepTable, HasSimulationAndDrawingApart) {
  const bench::Table table = sweep_table({made_up_result()});
  EXPECT_EQ(cell_of(table, "CPU s"), "9");
  EXPECT_EQ(cell_of(table, "simulation CPU s"), "2.5");
  EXPECT_EQ(cell_of(table, "drawing CPU s"), "4.25");
  EXPECT_EQ(cell_of(table, "Newton iterations"), "7");
  EXPECT_EQ(cell_of(table, "largest strain"), "0.02");
  EXPECT_EQ(cell_of(table, "kinetic energy at the end J"), "0.25");
}

TEST(SweepTable, KeepsWhetherAnErrorIsComparableAndSumsUpNoErrorsOfSteps) {
  SweepResult result = made_up_result();
  EXPECT_EQ(cell_of(sweep_table({result}), "error m"), "");
  EXPECT_EQ(cell_of(sweep_table({result}), "comparable"), "");
  result.stats["error"] = {{"comparable", false}, {"all", {{"position_m", 0.003}}}};
  EXPECT_EQ(cell_of(sweep_table({result}), "error m"), "0.003");
  EXPECT_EQ(cell_of(sweep_table({result}), "comparable"), "no");
  result.stats["error"]["comparable"] = true;
  EXPECT_EQ(cell_of(sweep_table({result}), "comparable"), "yes");
}

TEST(SweepTable, EachColumnIsDocumented) {
  const std::string page = support::read_bytes(WEFT_SOURCE_DIR "/scenes/data.md");
  std::vector<std::string> columns = sweep_table({made_up_result()}).front();
  columns.erase(columns.begin());  // the varied key
  const std::size_t begin = page.find("## Columns of a sweep"), table = page.find("|---|", begin);
  ASSERT_NE(begin, std::string::npos);
  std::istringstream lines(page.substr(table, page.find("\n\n", table) - table));
  std::vector<std::string> documented;
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t open = line.find('`'); open != std::string::npos)
      documented.push_back(line.substr(open + 1, line.find('`', open + 1) - open - 1));
  EXPECT_EQ(documented, columns);
}

TEST(SweepLabels, AreOneLine) {
  SweepRun run;
  run.difference = {{"size", "[1,\n2]"}};
  EXPECT_EQ(label_of(run), "size=[1,\\x0a2]");
}

TEST(SweepLabels, AreNotCut) {
  SweepRun run;
  for (int i = 0; i < 50; ++i) run.difference.emplace_back(fmt::format("key{}", i), "0.123");
  EXPECT_TRUE(contains(label_of(run), "key0=0.123  key1=0.123"));
  EXPECT_TRUE(label_of(run).ends_with("key49=0.123"));
}

class SweepSheet : public support::TestFolder {};

TEST_F(SweepSheet, OfTooManyRunsShowsTheFirstRows) {
  video::Encoder encoder(folder_ / "a.mp4", {.width = 16, .height = 8192, .metadata = {}});
  encoder.add(image::Image(16, 8192));
  encoder.finish();
  SweepResult result = made_up_result();
  result.video = folder_ / "a.mp4";
  result.run.difference.clear();
  write_sweep_sheet(folder_ / "sheet.png", std::vector<SweepResult>(5, result), "", {});
  const image::Image sheet = image::read_png(folder_ / "sheet.png");  // shows only the first of two rows
  EXPECT_GT(sheet.width, 3 * 16);
  EXPECT_GT(sheet.height, 8192);
  EXPECT_LT(sheet.height, 2 * 8192);
}

TEST_F(SweepSheet, OfAnEarlierSweepDoesNotStayIfNoRunHasAPicture) {
  support::write_bytes(folder_ / "sheet.png", "of an earlier sweep");
  SweepResult result = made_up_result();
  result.video = folder_ / "none.mp4";
  write_sweep_sheet(folder_ / "sheet.png", {result}, "", {});
  EXPECT_FALSE(fs::exists(folder_ / "sheet.png"));
}

class Sweeps : public CachedRun {
 protected:
  static constexpr const char* kRadius = "obstacle.ball.radius=0.1,0.11";
  Arguments with_sweep(const Arguments& more) const {
    return joined({"sweep", "s.toml", "-o", "w", "--size", "64x36", "--quality", "draft"}, more);
  }
  Outcome sweep(const Arguments& more) const { return run_weft(with_sweep(more), folder_); }
  std::string table() const { return support::read_bytes(folder_ / "w/table.csv"); }
};

TEST_F(Sweeps, HaveTheVideosOfSingleRunsASheetATableAndAPage) {
  const Arguments arguments{"--set",  kRadius, "--set", "time.duration=0.2", "--set", "time.step=0.02,0.01",
                            "--jobs", "2"};
  expect_exit(sweep(arguments), 0);
  expect_well({"run", "s.toml", "-o", "one.mp4", "--set", "obstacle.ball.radius=0.11", "--set", "time.duration=0.2",
               "--set", "time.step=0.01"});
  EXPECT_EQ(decoded("w/radius=0.11_step=0.01/s.mp4"), decoded("one.mp4"));
  const std::string csv = table();
  EXPECT_TRUE(csv.starts_with("radius,step,exit code,CPU s,simulation CPU s,drawing CPU s,frames,Newton iterations,"))
      << csv;
  EXPECT_TRUE(contains(csv, "\n0.11,0.01,0,")) << csv;
  EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
  const image::Image sheet = image::read_png(folder_ / "w/sheet.png");
  EXPECT_GT(sheet.width, 2 * 64);
  EXPECT_GT(sheet.height, 2 * 36);
  EXPECT_TRUE(fs::exists(folder_ / "w/page/index.html"));
}

TEST_F(Sweeps, GoOnWithWhatIsNotDoneAndPassOverTheRest) {
  const Arguments arguments{"--set", "time.duration=0.08,0.12,0.120"};
  EXPECT_EQ(sweep(arguments).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "w/duration=0.120")) << "the same scene was run twice";
  fs::remove(folder_ / "w/duration=0.08/s.mp4");
  const auto written = fs::last_write_time(folder_ / "w/duration=0.12/s.mp4");
  fs::remove(folder_ / "w/duration=0.08/s.json");
  const Outcome again = sweep(arguments);
  expect_exit(again, 0, "] duration=0.12: done already\n");
  EXPECT_TRUE(contains(again.err, "duration=0.120: the same scene as duration=0.12\n")) << again.err;
  EXPECT_TRUE(fs::exists(folder_ / "w/duration=0.08/s.mp4"));
  EXPECT_EQ(fs::last_write_time(folder_ / "w/duration=0.12/s.mp4"), written);
  expect_exit(sweep({"--set", "time.duration=0.08,0.12", "--frames", "0:2"}), 6, "w: holds runs with other options");
  fs::create_directories(folder_ / "w2/mine");
  EXPECT_EQ(run_weft({"sweep", "s.toml", "-o", "w2", "--set", kRadius}, folder_).exit_code, 6);
}

// Results do not depend on the number of threads, which `farm submit` does not pass on.
TEST_F(Sweeps, GoOnWithAnotherNumberOfThreads) {
  ASSERT_EQ(sweep({"--set", "time.duration=0.08", "--threads", "2"}).exit_code, 0);
  for (const Arguments& threads : {Arguments{}, Arguments{"--threads", "1"}}) {
    expect_exit(sweep(joined({"--set", "time.duration=0.08"}, threads)), 0, "duration=0.08: done already\n");
  }
  expect_exit(run_weft({"farm", "submit", "s.toml", "-o", "w", "--size", "64x36", "--quality", "draft", "--set",
                        "time.duration=0.08", "--dry-run"},
                       folder_),
              0, "all runs are done");
}

TEST_F(Sweeps, AFolderInThePlaceOfAVideoIsNoRunThatIsDone) {
  const Arguments arguments{"--set", "time.duration=0.08"};
  EXPECT_EQ(sweep(arguments).exit_code, 0);
  fs::remove(folder_ / "w/duration=0.08/s.mp4");
  fs::create_directories(folder_ / "w/duration=0.08/s.mp4");
  expect_exit(sweep(arguments), 6, "s.mp4: expected the name of a file to write, got a folder");
  EXPECT_EQ(run_weft({"farm", "status", "w"}, folder_).exit_code, 9);
}

TEST_F(Sweeps, RunsThatWereToBeRepeatedAreNotDoneUntilThen) {
  const Arguments arguments{"--set", "time.duration=0.08,0.12", "--camera"};
  const auto with = [&](const Arguments& more) { return sweep(joined(arguments, more)); };
  EXPECT_EQ(sweep({"--set", "time.duration=0.08,0.12"}).exit_code, 0);
  EXPECT_EQ(with({"nowhere", "--overwrite"}).exit_code, 2);
  const Outcome again = with({"nowhere"});
  EXPECT_EQ(again.exit_code, 2) << again.err;
  EXPECT_FALSE(contains(again.err, "done already")) << again.err;
}

TEST_F(Sweeps, AreNotReportedBeforeTheyBegin) {
  expect_exit(sweep({"--set", kRadius, "--report"}), 4, "w: expected the folder of a sweep");
  EXPECT_FALSE(fs::exists(folder_ / "w")) << "the sweep would refuse a folder that it has not begun";
}

TEST_F(Sweeps, NameTheRunsThatFailAndKeepTheOthers) {
  // Only the first of the two runs has a camera named v.
  const std::string cameras =
      "camera=[{name='v',position=[1,-1,1],target=[0,0,0.2]}],"
      "[{name='w',position=[1,-1,1],target=[0,0,0.2]}]";
  const Outcome outcome = sweep({"--set", cameras, "--set", "time.duration=0.08", "--camera", "v"});
  expect_exit(outcome, 2, "exit code 2: weft: --camera: expected w, got v");
  EXPECT_TRUE(contains(outcome.err, "weft: 1 of 2 runs failed:\n")) << outcome.err;
  EXPECT_TRUE(contains(table(), ",2,,,,0,,,,,,,\"camera=")) << "figures of no frame: " << table();
  EXPECT_TRUE(fs::exists(folder_ / "w/sheet.png"));
}

TEST_F(Sweeps, MistakesOfAnyRunEndThemBeforeTheFirst) {
  const Outcome outcome = sweep({"--set", "obstacle.ball.radius=0.1,-1", "--set", "cloth.cloth.position=[0,0,1],3"});
  expect_exit(outcome, 3, "--set obstacle.ball.radius=-1: ");
  EXPECT_TRUE(contains(outcome.err, "--set cloth.cloth.position=3: ")) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "w"));
  EXPECT_EQ(sweep({}).exit_code, 2);
  EXPECT_EQ(run_weft({"sweep", "s.toml", "-o", ".", "--set", kRadius}, folder_).exit_code, 2) << "holds the scene";
}

TEST_F(Sweeps, RefuseAFolderThatHoldsAFileOfALaterRun) {
  fs::create_directories(folder_ / "w");
  for (const char* picture : {"a.png", "w/b.png"}) image::write_png(folder_ / picture, image::Image(16, 16));
  expect_exit(sweep({"--set", "cloth.cloth.look.image=a.png,w/b.png"}), 2,
              "-o: w holds a file of the scene, which is read");
}

TEST_F(Sweeps, OfWhichNoneIsWellHaveAPageThatSaysWhyAndNoSheet) {
  expect_exit(sweep({"--set", "cloth.cloth.position=[0,0,0],[0,0,0.01]"}), 3,
              "w: table.md, table.csv, page/index.html\n");
  EXPECT_TRUE(contains(support::read_bytes(folder_ / "w/page/index.html"), "expected surfaces that are apart"));
}

TEST_F(Sweeps, StopInOrderAndGoOnToTheSameVideos) {
  const Arguments arguments{"--set", kRadius, "--set", "time.step=0.002"};
  Subprocess process(with_sweep(arguments), folder_);
  for (int i = 0; i < 3000 && !fs::exists(folder_ / "w/radius=0.1/.s.weft-cache/frame_00002.weft"); ++i) usleep(20'000);
  process.send(SIGTERM);
  expect_exit(process.wait(), 75, "2 of 2 runs are not finished; the same command continues");
  EXPECT_EQ(sweep({"--set", kRadius, "--set", "time.step=0.002"}).exit_code, 0);
  expect_well({"run", "s.toml", "-o", "one.mp4", "--set", "time.step=0.002"});
  EXPECT_EQ(decoded("w/radius=0.1/s.mp4"), decoded("one.mp4"));
}

// The second run has a complete video of the first sweep, and does not begin before the sweep is stopped.
TEST_F(Sweeps, ThatWereToBeRepeatedAndAreStoppedGoOnWithAllRuns) {
  const Arguments arguments{"--set", kRadius, "--set", "time.step=0.002"};
  ASSERT_EQ(sweep(arguments).exit_code, 0);
  Arguments repeated = arguments;
  repeated.emplace_back("--overwrite");
  Subprocess process(with_sweep(repeated), folder_);
  for (int i = 0; i < 3000 && !fs::exists(folder_ / "w/radius=0.1/.s.weft-cache/frame_00002.weft"); ++i) usleep(20'000);
  process.send(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, 75);
  expect_exit(sweep(arguments), 0);
  EXPECT_TRUE(fs::exists(folder_ / "w/radius=0.11/s.json")) << "the run has no statistics: " << table();
}

/// Waits up to five seconds until no process holds the lock of this cache. Returns whether the lock is free.
bool is_left(const fs::path& cache) {
  const int lock = ::open((cache / "lock").c_str(), O_RDONLY);
  bool left = false;
  for (int i = 0; i < 250 && !left; ++i) {
    left = ::flock(lock, LOCK_EX | LOCK_NB) == 0;
    if (!left) usleep(20'000);
  }
  ::close(lock);
  return left;
}

TEST_F(Sweeps, ThatAreKilledTakeTheirRunsWithThem) {
  // Without the signal, the run would take half a minute.
  Subprocess process(with_sweep({"--set", "time.step=0.0001,0.01"}), folder_);
  const fs::path cache = folder_ / "w/step=0.0001/.s.weft-cache";
  for (int i = 0; i < 3000 && !fs::exists(cache / "frame_00000.weft"); ++i) usleep(20'000);
  process.send(SIGKILL);
  EXPECT_TRUE(is_left(cache)) << "the run goes on";
}

}  // namespace
}  // namespace weft::cli
