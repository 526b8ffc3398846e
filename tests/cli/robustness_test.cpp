// Runs on unattended machines: full and read-only disks, killed runs, missing parts.
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "cli/cached_run.hpp"
#include "cli/video_probe.hpp"
#include "film/cache/reader.hpp"
#include "film/image/png.hpp"
#include "support/ply.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class Robustness : public CachedRun {
 protected:
  /// Expects every file with a final name to be complete. Returns the number of these files.
  int expect_whole_files() const {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const fs::path& file = entry.path();
      if (!entry.is_regular_file() || is_hidden(file)) continue;
      ++count;
      if (file.extension() == ".png") {
        EXPECT_NO_THROW(image::read_png(file));
      } else if (file.extension() == ".ply") {
        EXPECT_NO_THROW(support::read_ply(file));
      } else if (file.extension() == ".json") {
        EXPECT_TRUE(nlohmann::json::accept(support::read_bytes(file))) << file;
      } else if (file.extension() == ".mp4") {
        EXPECT_EQ(probe_video(file).frames, kFrames) << file;
      }
    }
    if (cache::is_cache(folder_ / "c") && fs::exists(folder_ / "c/surfaces.weft")) {
      const cache::Reader reader(folder_ / "c");
      for (const int frame : reader.frames()) EXPECT_NO_THROW(reader.verify(frame));
      EXPECT_NO_THROW(reader.state());
    }
    return count;
  }

  /// True for temporary files and the working cache of a run.
  bool is_hidden(const fs::path& file) const {
    for (const fs::path& part : fs::relative(file, folder_))
      if (part.string().starts_with(".")) return true;
    return false;
  }

  const Arguments run_ = joined({"run", "s.toml", "-o", "v/a.mp4", "--meshes", "m", "--stats", "s.json"}, kSmall);
  const Arguments pictures_ = joined({"run", "s.toml", "-o", "p/{frame}.png"}, kSmall);
  const Arguments simulate_{"simulate", "s.toml", "--cache", "c", "--progress", "none"};
};

TEST_F(Robustness, KilledAtAnyMomentNoFileUnderAFinalNameIsHalf) {
  using Clock = std::chrono::steady_clock;
  std::mt19937 random(20261121);
  for (const Arguments& arguments : {run_, pictures_, simulate_}) {
    const auto begin = Clock::now();
    ASSERT_EQ(run_weft(arguments, folder_).exit_code, 0);
    const double whole = std::chrono::duration<double>(Clock::now() - begin).count();
    for (int moment = 0; moment < 4; ++moment) {
      for (const char* output : {"v", "m", "p", "c", "s.json"}) fs::remove_all(folder_ / output);
      Subprocess process(arguments, folder_);
      std::this_thread::sleep_for(
          std::chrono::duration<double>(std::uniform_real_distribution<double>(0, whole)(random)));
      process.send(SIGKILL);
      process.wait();
      EXPECT_GE(expect_whole_files(), 1);
    }
  }
}

/// A file system of 64 MB in memory, in a mount namespace of this process. It disappears when the process ends.
class SmallDisk : public Robustness {
 protected:
  void SetUp() override {
    CachedRun::SetUp();
    scene_ = support::read_bytes(folder_ / "s.toml");
    const bool mounted = ::unshare(CLONE_NEWNS) == 0 &&
                         ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                         ::mount("weft", folder_.c_str(), "tmpfs", 0, "size=64m") == 0;
    if (!mounted) GTEST_SKIP() << "no file system can be mounted here; that takes root";
    support::write_bytes(folder_ / "s.toml", scene_);
  }
  void TearDown() override {
    ::umount2(folder_.c_str(), MNT_DETACH);
    CachedRun::TearDown();
  }

  /// Fills the disk except for about this number of bytes.
  void leave(std::size_t bytes) const {
    const fs::space_info space = fs::space(folder_);
    ASSERT_GT(space.available, bytes);
    support::write_bytes(folder_ / "ballast", std::string(space.available - bytes, 'x'));
  }

 private:
  std::string scene_;
};

TEST_F(SmallDisk, FullAtAnyMomentLeavesWholeFilesAndSaysSo) {
  for (const std::size_t room : {4u << 10, 40u << 10, 200u << 10}) {
    leave(room);
    for (const Arguments& arguments : {run_, pictures_, simulate_}) {
      for (const char* output : {"v", "m", "p", "c", "s.json"}) fs::remove_all(folder_ / output);
      const Outcome outcome = run_weft(arguments, folder_);
      const bool failed = outcome.exit_code != 0;
      EXPECT_TRUE(failed || room > 4u << 10) << arguments[0] << " fits into 4 KB";
      EXPECT_TRUE(!failed || outcome.exit_code == 6) << outcome.exit_code << outcome.err;
      EXPECT_TRUE(!failed || contains(outcome.err, "No space left on device")) << outcome.err;
      expect_whole_files();
      EXPECT_TRUE(failed || arguments[0] == "simulate" || fs::exists(folder_ / "v/a.mp4") ||
                  fs::exists(folder_ / "p/20.png"));
      for (const auto& entry : fs::recursive_directory_iterator(folder_))
        EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
    }
    fs::remove(folder_ / "ballast");
  }
}

TEST_F(SmallDisk, FullWhileAPictureIsReplacedKeepsTheOldOne) {
  ASSERT_EQ(weft({"thumbnail", "s.toml", "-o", "t.png"}).exit_code, 0);
  const std::string before = support::read_bytes(folder_ / "t.png");
  leave(0);
  for (const char* command : {"thumbnail", "sheet"}) {
    expect_exit(weft({command, "s.toml", "-o", "t.png", "--overwrite"}), 6);
    EXPECT_EQ(support::read_bytes(folder_ / "t.png"), before) << command;
  }
}

TEST_F(SmallDisk, ThatIsReadOnlyIsRefusedBeforeSimulating) {
  ASSERT_EQ(::mount(nullptr, folder_.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  for (const Arguments& arguments :
       {run_, pictures_, simulate_, Arguments{"sheet", "s.toml"}, Arguments{"thumbnail", "s.toml", "-o", "t.png"}}) {
    const Outcome outcome = run_weft(arguments, folder_);
    EXPECT_EQ(outcome.exit_code, 6) << arguments[0] << ": " << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "Read-only file system")) << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "simulated")) << "it was simulated first\n" << outcome.err;
  }
}

TEST_F(Robustness, MachineWithoutAnEncoderIsToldSoAndDrawsPicturesAllTheSame) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer must be the first library of a program";
#endif
  const fs::path library = fs::path(WEFT_PROGRAM).parent_path() / "libweft_no_encoder.so";
  ASSERT_TRUE(fs::exists(library)) << library;
  ::setenv("LD_PRELOAD", library.c_str(), 1);
  const Outcome run = Subprocess(run_, folder_).wait(), doctor = Subprocess({"doctor"}, folder_).wait();
  const Outcome pictures = Subprocess(pictures_, folder_).wait();
  ::unsetenv("LD_PRELOAD");
  expect_exit(run, 6, "this libavcodec has no libx264; install");
  EXPECT_FALSE(fs::exists(folder_ / "v/a.mp4"));
  EXPECT_EQ(doctor.exit_code, 6) << doctor.out;
  EXPECT_TRUE(contains(doctor.out, "none: libavcodec was built without libx264")) << doctor.out;
  EXPECT_EQ(pictures.exit_code, 0) << pictures.err;
}

}  // namespace
}  // namespace weft::cli
