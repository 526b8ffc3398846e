// weft farm without a scheduler: the test runs the tasks of the scripts one after the other. tests/farm/farm_test.py
// uses Slurm itself.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

#include "cli/cached_run.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class Farms : public CachedRun {
 protected:
  static constexpr const char* kRadius = "obstacle.ball.radius=0.1,0.11";

  Outcome farm(const Arguments& more) const { return run_weft(joined({"farm"}, more), folder_); }
  /// Submits fewer frames than the scene has; the camera is computed from all frames of the scene.
  Outcome submit(const Arguments& more = {}) const {
    const Arguments arguments{
        "submit",    "s.toml",   "-o",       "a b",    "--set",  kRadius, "--size", "64x36",
        "--quality", "draft",    "--frames", "0:19:2", "--part", "4",     "--set",  "time.duration=0.8",
        "--dry-run", "--memory", "100",      "--time", "10"};
    return farm(joined(arguments, more));
  }
  /// Runs all tasks of `farm/tasks.tsv` in order, and returns the exit codes that are not 0.
  std::vector<int> do_tasks(const std::string& environment = "") const {
    std::vector<int> codes;
    std::ifstream in(folder_ / "a b/farm/tasks.tsv");
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      const int code = std::system((environment + " " + line.substr(line.rfind('\t') + 1)).c_str());
      if (code != 0) codes.push_back(WEXITSTATUS(code));
    }
    return codes;
  }
  /// Calls `weft farm` with scripts in place of Slurm's programs, which end with exit code 1.
  Outcome with_failing_slurm(const std::string& arguments) const {
    for (const char* program : {"sbatch", "squeue", "scancel"}) {
      support::write_bytes(folder_ / program, "#!/bin/sh\nexit 1\n");
      fs::permissions(folder_ / program, fs::perms::owner_all);
    }
    const int status =
        std::system(fmt::format("cd '{0}' && trap '' CHLD && PATH='{0}':\"$PATH\" exec '{1}' farm {2} >out 2>err",
                                folder_.string(), WEFT_PROGRAM, arguments)
                        .c_str());
    return {WEXITSTATUS(status), support::read_bytes(folder_ / "out"), support::read_bytes(folder_ / "err")};
  }
  std::string log(const std::string& task) const {
    return support::read_bytes(folder_ / "a b/farm/log" / (task + ".log"));
  }
};

TEST_F(Farms, TasksMakeWhatOneSweepMakes) {
  ASSERT_EQ(submit().exit_code, 0);
  EXPECT_EQ(farm({"status", "a b"}).exit_code, 9);
  EXPECT_TRUE(do_tasks().empty()) << log("simulate_0");
  const Outcome status = farm({"status", "a b"});
  EXPECT_EQ(status.exit_code, 0);
  EXPECT_TRUE(contains(status.out, "2 of 2 runs are done")) << status.out;
  expect_exit(run_weft({"sweep", "s.toml", "-o", "one", "--set", kRadius, "--size", "64x36", "--quality", "draft",
                        "--frames", "0:19:2", "--set", "time.duration=0.8"},
                       folder_),
              0);
  for (const char* run : {"radius=0.1", "radius=0.11"})
    EXPECT_TRUE(support::read_bytes(folder_ / "one" / run / "s.mp4") ==
                support::read_bytes(folder_ / "a b" / run / "s.mp4"))
        << run;
  for (const char* file : {"sheet.png", "table.csv", "page/index.html"})
    EXPECT_TRUE(fs::exists(folder_ / "a b" / file));
  const Outcome again = submit();
  EXPECT_TRUE(contains(again.err, "all runs are done")) << again.err;
  fs::remove(folder_ / "a b/radius=0.1/s.mp4");
  const Outcome partly = submit();
  EXPECT_TRUE(contains(partly.out, "--array=0\n")) << "only what is missing: " << partly.out;
}

TEST_F(Farms, SubmitOnlyTheReportIfOnlyTheReportFailed) {
  ASSERT_EQ(submit().exit_code, 0);
  ASSERT_TRUE(do_tasks().empty()) << log("simulate_0");
  support::write_bytes(folder_ / "a b/farm/log/report.code", "6   \n");
  const Outcome again = submit();
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(contains(again.err, "all runs are done")) << again.err;
  EXPECT_TRUE(contains(again.out, "submit_task report report --time=10\n")) << again.out;
  EXPECT_FALSE(contains(again.out, "submit_task simulate")) << again.out;
  EXPECT_TRUE(do_tasks().empty()) << log("report");
  EXPECT_TRUE(contains(submit().err, "all runs are done"));
  fs::remove(folder_ / "a b/table.csv");
  EXPECT_FALSE(contains(submit().err, "all runs are done"));
}

// After a change of looks, the simulation is still valid; its tasks only write the statistics anew. But the pictures
// show the earlier scene, so the films are not done.
TEST_F(Farms, FilmsOfAFormerSceneAreNotDone) {
  ASSERT_EQ(submit().exit_code, 0);
  ASSERT_TRUE(do_tasks().empty()) << log("simulate_0");
  support::write_bytes(folder_ / "s.toml",
                       support::read_bytes(folder_ / "s.toml") + "\nlook = { color = \"#000000\" }\n");
  const Outcome changed = submit();
  ASSERT_EQ(changed.exit_code, 0);
  EXPECT_TRUE(contains(changed.err, "warning: a b/radius=0.1/frames and 1 more folders: expected")) << changed.err;
  expect_exit(
      with_failing_slurm(
          "submit s.toml -o 'a b' --set obstacle.ball.radius=0.1,0.11 --size 64x36 --quality draft --frames 0:19:2 "
          "--part 4 --set time.duration=0.8 --memory 100 --time 10"),
      6, "which drawing tasks do not replace");
  const std::string task = "WEFT_PAUSE=0 sh '" + (folder_ / "a b/farm/task.sh").string() + "'";
  for (const char* run : {"0", "1"})
    EXPECT_EQ(std::system((task + " simulate " + run).c_str()), 0) << log("simulate_0");
  const Outcome status = farm({"status", "a b"});
  EXPECT_EQ(status.exit_code, 9) << status.out;
  const Outcome again = submit();
  EXPECT_FALSE(contains(again.err, "all runs are done")) << again.err;
}

// A program that was killed once succeeds on the second try. A program that finds a mistake is not tried again.
TEST_F(Farms, TasksThatWereKilledAreTriedAgain) {
  ASSERT_EQ(submit().exit_code, 0);
  support::write_bytes(folder_ / "killed",
                       "#!/bin/sh\nif [ ! -e \"$0_once\" ]; then : >\"$0_once\"; kill -9 $$; fi\nexec '" WEFT_PROGRAM
                       "' \"$@\"\n");
  fs::permissions(folder_ / "killed", fs::perms::owner_all);
  const std::string environment = "WEFT_PAUSE=0 WEFT='" + (folder_ / "killed").string() + "'";
  EXPECT_TRUE(do_tasks(environment).empty());
  EXPECT_TRUE(contains(log("simulate_0"), "exit code 137: try 1 of 3")) << log("simulate_0");

  fs::remove_all(folder_ / "a b");
  ASSERT_EQ(submit().exit_code, 0);
  support::write_bytes(folder_ / "s.toml", "[time]\nduration = -1\n");
  const std::vector<int> codes = do_tasks(environment);
  ASSERT_FALSE(codes.empty());
  EXPECT_EQ(codes.front(), 3);
  EXPECT_FALSE(contains(log("simulate_0"), "try 1"));
  const Outcome status = farm({"status", "a b"});
  EXPECT_EQ(status.exit_code, 9);
  EXPECT_TRUE(contains(status.out, "simulate_0 ended with exit code 3")) << status.out;
}

// SIGUSR1, which Slurm sends before the time limit, arrives during the pause between two tries.
TEST_F(Farms, TasksThatAreToStopBeginNoOtherTry) {
  ASSERT_EQ(submit().exit_code, 0);
  support::write_bytes(folder_ / "failing", "#!/bin/sh\necho \"$1\"\nexit 6\n");
  support::write_bytes(folder_ / "sleep", "#!/bin/sh\nkill -USR1 $PPID\n");
  for (const char* program : {"failing", "sleep"}) fs::permissions(folder_ / program, fs::perms::owner_all);
  do_tasks(fmt::format("PATH='{}':\"$PATH\" WEFT='{}'", folder_.string(), (folder_ / "failing").string()));
  const std::string said = log("simulate_0"), pause = said.substr(std::min(said.find("try 1 of 3"), said.size()));
  EXPECT_TRUE(contains(pause, "the time limit is near")) << said;
  EXPECT_FALSE(contains(pause, "\nsimulate\n")) << "the program was called again: " << said;
}

TEST_F(Farms, StatusCountsTheFramesThatAreRequested) {
  ASSERT_EQ(submit().exit_code, 0);
  const std::string task = "sh '" + (folder_ / "a b/farm/task.sh").string() + "'";
  EXPECT_TRUE(contains(farm({"status", "a b"}).out, "radius=0.1   not begun"));
  ASSERT_EQ(std::system((task + " simulate 0 && " + task + " draw 0 0").c_str()), 0) << log("simulate_0");
  const Outcome status = farm({"status", "a b"});
  EXPECT_TRUE(contains(status.out, "radius=0.1   4 of 10 frames drawn")) << status.out;
}

TEST_F(Farms, StatusEscapesControlCharactersOfLogs) {
  ASSERT_EQ(submit().exit_code, 0);
  support::write_bytes(folder_ / "a b/farm/log/t.code", "3");
  support::write_bytes(folder_ / "a b/farm/log/t.log", "weft: \x1b[31mred\n");
  const Outcome status = farm({"status", "a b"});
  EXPECT_TRUE(contains(status.out, "\n  \\x1b[31mred\n")) << status.out;
}

TEST_F(Farms, RequestTheMemoryThatTheirPicturesNeed) {
  const auto megabytes = [&](const char* folder, const char* size) {
    const Outcome outcome =
        farm({"submit", "s.toml", "-o", folder, "--dry-run", "--time", "10", "--quality", "draft", "--size", size});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::size_t option = outcome.out.find("--mem=");
    return option == std::string::npos ? 0 : std::atoi(outcome.out.c_str() + option + 6);
  };
  EXPECT_GT(megabytes("large", "2560x1440"), megabytes("small", "64x36") + 30);
}

TEST_F(Farms, AreRememberedByADryRun) {
  ASSERT_EQ(submit().exit_code, 0);
  support::write_bytes(folder_ / "a b/farm/jobs", "7\tsimulate\n");
  EXPECT_EQ(submit().exit_code, 0);
  EXPECT_EQ(support::read_bytes(folder_ / "a b/farm/jobs"), "7\tsimulate\n");
}

// If scripts were replaced, tasks in the queue would run scripts other than those with which they were submitted. In
// this test, Slurm does not answer whether tasks wait.
TEST_F(Farms, ADryRunReplacesNoScriptsOfTasksThatMayWait) {
  const std::string command = "submit s.toml -o one --memory 100 --time 10 --dry-run";
  ASSERT_EQ(with_failing_slurm(command).exit_code, 0);
  support::write_bytes(folder_ / "one/farm/jobs", "7\tsimulate\n");
  std::map<std::string, std::string> before;
  for (const char* file : {"farm/task.sh", "farm/submit.sh", "farm/tasks.tsv", "sweep.json"})
    before[file] = support::read_bytes(folder_ / "one" / file);
  const Outcome outcome = with_failing_slurm(command + " --part 7 --set time.step=0.01,0.02");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "frames_each=7\n")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "the scripts are printed, not written")) << outcome.err;
  for (const auto& [file, bytes] : before) EXPECT_EQ(support::read_bytes(folder_ / "one" / file), bytes) << file;
  EXPECT_FALSE(fs::exists(folder_ / "one/step=0.01"));
}

// Some callers ignore SIGCHLD, and programs inherit this. Exit codes of child processes would then be lost.
TEST_F(Farms, FailuresOfSlurmAreNoSuccessesAndNoEmptyQueue) {
  EXPECT_EQ(with_failing_slurm("submit s.toml -o one --memory 100 --time 10").exit_code, 6);
  support::write_bytes(folder_ / "one/farm/jobs", "7\tsimulate\n");
  for (const char* command : {"cancel one", "submit s.toml -o one --memory 100 --time 10"}) {
    const Outcome outcome = with_failing_slurm(command);
    EXPECT_EQ(outcome.exit_code, 6) << command << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "squeue ended with 1")) << outcome.err;
  }
  const Outcome status = with_failing_slurm("status one");
  EXPECT_EQ(status.exit_code, 9) << status.err;
  EXPECT_TRUE(contains(status.out, "0 of 1 runs are done")) << status.out;
  EXPECT_TRUE(contains(status.err, "warning: squeue ended with 1")) << status.err;
}

TEST_F(Farms, NameNoOptionThatTheyLackIfTheFolderHasOtherRuns) {
  EXPECT_EQ(submit().exit_code, 0);
  expect_exit(submit({"--camera", "front"}), 6, "; give the same options or another name\n");
}

TEST_F(Farms, RefuseWhatTheyCannotDo) {
  EXPECT_EQ(farm({"submit", "s.toml"}).exit_code, 2) << "no folder";
  EXPECT_EQ(farm({"status", "s.toml", "-o", "x"}).exit_code, 2);
  EXPECT_EQ(farm({"status", "none"}).exit_code, 4);
  EXPECT_EQ(farm({"wait", "none"}).exit_code, 2);
  EXPECT_EQ(farm({"submit", "s.toml", "-o", "x", "--set", "time.step=0.01,-1"}).exit_code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

}  // namespace
}  // namespace weft::cli
