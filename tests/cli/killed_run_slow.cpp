// Runs that are killed at any moment and then resumed.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <random>
#include <thread>

#include "cli/cached_run.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using std::chrono::duration;

class KilledAnywhere : public CachedRun {
 protected:
  Arguments run(const char* output, const char* meshes) const {
    return {"run",    "s.toml",  "-o",        output,    "--meshes",   meshes, "--set", "cloth.cloth.particles=[31,31]",
            "--size", "320x180", "--quality", "preview", "--progress", "none"};
  }

  // Expects every file with a final name to equal that of an uninterrupted run.
  void expect_no_half_file(const std::map<std::string, std::string>& whole_meshes) const {
    if (fs::exists(folder_ / "a.mp4")) {
      EXPECT_EQ(decoded("a.mp4"), whole_video_);
    }
    if (!fs::exists(folder_ / "m")) return;
    for (const auto& [name, bytes] : contents("m", ".ply")) {
      if (name.starts_with('.')) continue;
      ASSERT_TRUE(whole_meshes.contains(name)) << name;
      EXPECT_TRUE(bytes == whole_meshes.at(name)) << name << " is not whole";
    }
  }

  std::string whole_video_;
};

TEST_F(KilledAnywhere, RunGoesOnToTheSameFramesAndMeshes) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome whole = run_weft(run("whole.mp4", "mw"), folder_);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const double seconds = duration<double>(std::chrono::steady_clock::now() - start).count();
  whole_video_ = decoded("whole.mp4");
  const auto whole_meshes = contents("mw", ".ply");
  std::mt19937 random(20);
  std::uniform_real_distribution<double> moment(0, 1.1 * seconds);
  int killed_twice = 0;
  for (int round = 0; round < 20; ++round) {
    // Some runs are killed again while they resume.
    for (int attempt = 0; attempt <= round % 3; ++attempt) {
      Arguments arguments = run("a.mp4", "m");
      if (attempt > 0) arguments.push_back("--resume");
      Subprocess process(arguments, folder_);
      std::this_thread::sleep_for(duration<double>(moment(random)));
      process.send(SIGKILL);
      const Outcome outcome = process.wait();
      ASSERT_TRUE(outcome.exit_code == 128 + SIGKILL || outcome.exit_code == 0 || outcome.exit_code == 6)
          << outcome.err;
      killed_twice += attempt > 0 && outcome.exit_code == 128 + SIGKILL;
      expect_no_half_file(whole_meshes);
    }
    if (!fs::exists(folder_ / "a.mp4") || fs::exists(folder_ / ".a.weft-cache")) {
      Arguments arguments = run("a.mp4", "m");
      arguments.push_back("--resume");
      const Outcome resumed = run_weft(arguments, folder_);
      ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    }
    EXPECT_EQ(decoded("a.mp4"), whole_video_) << "round " << round;
    expect_same("m", "mw", ".ply", whole_meshes.size());
    for (const char* folder : {".", "m"})
      for (const auto& entry : fs::directory_iterator(folder_ / folder))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << " was left";
    fs::remove(folder_ / "a.mp4");
    fs::remove_all(folder_ / "m");
  }
  EXPECT_GT(killed_twice, 0);
}

}  // namespace
}  // namespace weft::cli
