// The commands run, simulate and render, and --resume, give the same bits, whichever of them makes the frames.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/cached_run.hpp"
#include "cli/video_probe.hpp"
#include "film/cache/reader.hpp"
#include "film/cache/writer.hpp"
#include "film/image/png.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kPictures = "{frame:05}.png";

// Statistics without values that differ between runs: times, memory and paths.
Json read_reproducible_statistics(const fs::path& file) {
  Json stats = Json::parse(support::read_bytes(file));
  for (const char* key : {"totals", "peak_memory_bytes", "scene_file", "output", "cache_bytes"}) stats.erase(key);
  for (Json& frame : stats.at("frames"))
    for (const char* stage : {"simulate", "collide", "render", "encode"}) {
      frame.erase(std::string(stage) + "_ms");
      frame.erase(std::string(stage) + "_cpu_ms");
    }
  return stats;
}

TEST_F(CachedRun, SimulateAndRenderGiveThePixelsMeshesAndFiguresOfRun) {
  expect_well({"run", "s.toml", "-o", std::string("a/") + kPictures, "--meshes", "ma", "--stats", "a.json"});
  expect_well({"simulate", "s.toml", "--cache", "c", "--meshes", "mc", "--stats", "c.json"});
  expect_well({"render", "c", "-o", std::string("b/") + kPictures, "--meshes", "mb", "--stats", "b.json"});
  expect_same("a", "b", ".png", kFrames);
  expect_same("ma", "mb", ".ply", 3 * kFrames);
  expect_same("ma", "mc", ".ply", 3 * kFrames);
  EXPECT_EQ(read_reproducible_statistics(folder_ / "a.json"), read_reproducible_statistics(folder_ / "b.json"));
  expect_same("a", "b", ".toml", 1);
}

TEST_F(CachedRun, VideoFromACacheIsThatOfRun) {
  expect_well({"run", "s.toml", "-o", "a.mp4", "--frames", "4:18:2"});
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"render", "c", "-o", "b.mp4", "--frames", "4:18:2"});
  EXPECT_EQ(decoded("a.mp4"), decoded("b.mp4"));
  EXPECT_EQ(probe_video(folder_ / "a.mp4").metadata, probe_video(folder_ / "b.mp4").metadata);
}

TEST_F(CachedRun, OddSizesOfVideosAreTold) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", "0:2"});
  const auto reported_size = [&](const std::string& size, const Arguments& more) {
    const Outcome outcome =
        run_weft(joined({"render", "c", "--size", size, "--partial", "--overwrite", "-o"}, more), folder_);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto at = outcome.err.find("the video gets ");
    return at == std::string::npos ? "" : outcome.err.substr(at + 15, outcome.err.find(',', at) - at - 15);
  };
  EXPECT_EQ(reported_size("65x37", {"a.mp4"}), "66x38");
  EXPECT_EQ(reported_size("64x37", {"a.mov", "--codec", "prores"}), "64x38");
  EXPECT_EQ(reported_size("64x36", {"a.mp4"}), "");
  EXPECT_EQ(reported_size("65x37", {"a.mkv", "--codec", "ffv1"}), "") << "which keeps any size";
  EXPECT_EQ(reported_size("65x37", {"{frame}.png"}), "");
}

TEST_F(CachedRun, FourProcessesAtOnceRenderTheQuartersOfOneCache) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"render", "c", "-o", std::string("whole/") + kPictures});
  std::vector<std::unique_ptr<Subprocess>> processes;
  for (const char* frames : {"15:21", "10:15", "0:5", "5:10"})
    processes.push_back(std::make_unique<Subprocess>(
        joined({"render", "c", "-o", std::string("parts/") + kPictures, "--frames", frames}, kSmall), folder_, 0,
        Subprocess::Start::fork));
  for (const auto& process : processes) {
    expect_exit(process->wait(), 0);
  }
  expect_same("whole", "parts", ".png", kFrames);
}

TEST_F(CachedRun, FramesHaveTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::uint64_t> hashes;
  for (const char* threads : {"1", "2", "3", "8"}) {
    expect_well({"simulate", "s.toml", "--cache", threads, "--threads", threads});
    hashes.push_back(hash_of_frames(threads, kFrames));
  }
  EXPECT_EQ(hashes, std::vector<std::uint64_t>(4, hashes[0]));
}

TEST_F(CachedRun, SimulationGoesOnWithTheSameBitsFromAnyFrame) {
  expect_well({"simulate", "s.toml", "--cache", "whole"});
  const std::uint64_t expected = hash_of_frames("whole", kFrames);
  for (const char* end : {":1", ":13", ":21"}) {
    expect_well({"simulate", "s.toml", "--cache", "c", "--frames", end});
    expect_well({"simulate", "s.toml", "--cache", "c", "--resume"});
    EXPECT_EQ(hash_of_frames("c", kFrames), expected) << end;
    fs::remove_all(folder_ / "c");
  }
}

TEST_F(CachedRun, SimulationGoesOnFromTheMiddleOfItsPreroll) {
  const auto simulate = [&](Arguments more) {
    more.insert(more.begin(), {"simulate", "s.toml", "--set", "time.preroll=0.4"});
    return more;
  };
  Subprocess weft(simulate({"--cache", "c", "--set", "time.step=2.5e-4", "--progress", "none"}), folder_);
  // Wait until the first state file exists.
  for (int i = 0; i < 3000 && !fs::exists(folder_ / "c/state.weft"); ++i) usleep(20'000);
  weft.send(SIGTERM);
  EXPECT_EQ(weft.wait().exit_code, 75);
  EXPECT_LT(cache::Reader(folder_ / "c").state()->frame, 0);
  EXPECT_TRUE(cache::Reader(folder_ / "c").frames().empty());
  expect_well(simulate({"--cache", "c", "--set", "time.step=2.5e-4", "--resume", "--frames", ":3"}));
  expect_well(simulate({"--cache", "once", "--set", "time.step=2.5e-4", "--frames", ":3"}));
  EXPECT_EQ(hash_of_frames("c", 3), hash_of_frames("once", 3));
}

TEST_F(CachedRun, EditedSceneNeverMeetsOldFrames) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":5"});
  const Outcome edited = weft({"simulate", "s.toml", "--cache", "c", "--resume", "--set", "obstacle.ball.radius=0.11"});
  expect_exit(edited, 6, "which has changed since");
  EXPECT_TRUE(contains(edited.err, "omit --resume to start again, or undo the change")) << edited.err;
  expect_well({"simulate", "s.toml", "--cache", "c", "--resume"});
  expect_exit(weft({"simulate", "s.toml", "--cache", "c"}), 6,
              "c: holds a cache already; give --resume to continue it, --overwrite");
  expect_well({"simulate", "s.toml", "--cache", "c", "--overwrite", "--frames", ":2"});
  EXPECT_EQ(cache::Reader(folder_ / "c").frames().size(), 2u) << "frames of the cache before are left";
}

TEST_F(CachedRun, ChangedLooksGoOnAndDressWhatWasKept) {
  const Arguments looks{
      "--set", "cloth.cloth.look.color=[1,0,0]", "--set",
      "camera=[{name='v',target=[0,0,0],keys=[{time=0,position=[1,-2,1]},{time=0.8,position=[2,-1,1]}]}]"};
  const auto with_looks = [&](const Arguments& arguments) { return joined(arguments, looks); };
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  expect_well(with_looks({"simulate", "s.toml", "--cache", "c", "--resume"}));
  expect_well(with_looks({"simulate", "s.toml", "--cache", "whole"}));
  EXPECT_EQ(hash_of_frames("c", kFrames), hash_of_frames("whole", kFrames));
  expect_well({"render", "c", "-o", std::string("a/") + kPictures});
  expect_well({"render", "whole", "-o", std::string("b/") + kPictures});
  expect_same("a", "b", ".png", kFrames);
  // A longer duration extends a complete cache.
  expect_well(with_looks({"simulate", "s.toml", "--cache", "c", "--resume", "--set", "time.duration=0.88"}));
  EXPECT_EQ(cache::Reader(folder_ / "c").frames().size(), kFrames + 2u);
}

TEST_F(CachedRun, StoredFramesGetTheAngleOfALensForTheSizeOfTheRunThatGoesOn) {
  const auto simulate = [&](const Arguments& more) {
    const Arguments arguments{"simulate",   "s.toml",
                              "--cache",    "c",
                              "--quality",  "draft",
                              "--progress", "none",
                              "--set",      "camera=[{name='v',position=[1,-2,1],target=[0,0,0],focal_length=50}]"};
    expect_exit(run_weft(joined(arguments, more), folder_), 0);
  };
  simulate({"--size", "64x36", "--frames", ":8"});
  simulate({"--size", "36x64", "--frames", ":3", "--resume"});
  simulate({"--size", "36x64", "--resume"});
  // The longer side of the picture, which sees 36 mm of the film, is now vertical.
  const double angle = 360 / std::numbers::pi * std::atan(36.0 / (2 * 50));
  const cache::Reader reader(folder_ / "c");
  EXPECT_EQ(reader.frames().size(), static_cast<std::size_t>(kFrames));
  for (const int frame : reader.frames())
    EXPECT_NEAR(reader.snapshot(frame)->cameras[0].field_of_view, angle, 1e-9) << frame;
}

TEST_F(CachedRun, FramesThatWereNotDressedYetAreNotDrawn) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  const Arguments again{"simulate", "s.toml", "--cache", "c", "--resume", "--set", "cloth.cloth.look.color=[1,0,0]"};
  Arguments part = again;
  part.insert(part.end(), {"--frames", ":3"});
  expect_well(part);
  expect_well({"render", "c", "-o", "a.mp4", "--frames", ":3"});
  expect_exit(weft({"render", "c", "-o", "b.mp4", "--frames", "3:8"}), 9,
              "it has the look from before the scene was changed");
  expect_well(again);
  expect_well({"render", "c", "-o", "b.mp4"});
  // After this run, the cache holds all frames, but only the first three have the looks of the scene.
  const Arguments back{"simulate", "s.toml", "--cache", "c", "--resume"};
  part = back;
  part.insert(part.end(), {"--frames", ":3"});
  expect_well(part);
  EXPECT_FALSE(contains(weft(back).err, "complete already"));
  EXPECT_TRUE(contains(weft(back).err, "complete already"));
}

TEST_F(CachedRun, WholeCacheSaysSoAndStaysAsItIs) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  const auto before = contents("c", ".weft");
  const Outcome again = weft({"simulate", "s.toml", "--cache", "c", "--resume"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_TRUE(again.err.starts_with("note: c is complete already: frames 0:21\n")) << again.err;
  EXPECT_EQ(contents("c", ".weft"), before);
}

TEST_F(CachedRun, OverwriteOfAShorterRunLeavesNoFrameOfTheLongerOne) {
  const auto run = [](Arguments more) {
    more.insert(more.begin(), {"run", "s.toml", "-o", std::string("p/") + kPictures, "--meshes", "m"});
    return more;
  };
  expect_well(run({}));
  support::write_bytes(folder_ / "p/00077.jpg", "precious");
  expect_well(run({"--overwrite", "--set", "time.duration=0.12"}));
  EXPECT_EQ(contents("p", ".png").size(), 4u);
  EXPECT_EQ(contents("m", ".ply").size(), 3u * 4);
  EXPECT_TRUE(fs::exists(folder_ / "p/00077.jpg"));
  // Redrawing a part does not shorten the film.
  expect_well(run({"--overwrite", "--set", "time.duration=0.12", "--frames", "1:3"}));
  EXPECT_EQ(contents("p", ".png").size(), 4u);
  EXPECT_EQ(contents("m", ".ply").size(), 3u * 4);
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"render", "c", "-o", std::string("q/") + kPictures});
  expect_well({"render", "c", "-o", std::string("q/") + kPictures, "--frames", "3:5", "--overwrite"});
  EXPECT_EQ(contents("q", ".png").size(), static_cast<std::size_t>(kFrames));
}

TEST_F(CachedRun, AnotherBuildDoesNotGoOn) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":5"});
  cache::Manifest manifest = cache::Reader(folder_ / "c").manifest();
  manifest.program = "0123456789abcdef";
  support::write_bytes(folder_ / "c/manifest.json", cache::manifest_text(manifest));
  expect_exit(weft({"simulate", "s.toml", "--cache", "c", "--resume"}), 6, "was made by another build of Weft");
  expect_well({"render", "c", "-o", "c.mp4", "--frames", ":5"});
}

TEST_F(CachedRun, BrokenCacheIsSaidAndMadeAnew) {
  expect_well({"simulate", "s.toml", "--cache", "whole"});
  const std::uint64_t expected = hash_of_frames("whole", kFrames);
  for (const char* name : {"frame_00003.weft", "state.weft", "surfaces.weft", "manifest.json"}) {
    expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8", "--overwrite"});
    std::string bytes = support::read_bytes(folder_ / "c" / name);
    bytes.resize(bytes.size() / 2);
    support::write_bytes(folder_ / "c" / name, bytes);
    const Outcome render = weft({"render", "c", "-o", "c.mp4", "--overwrite"});
    if (name != std::string("state.weft")) {
      EXPECT_EQ(render.exit_code, name == std::string("frame_00003.weft") ? 9 : 4) << render.err;
      EXPECT_TRUE(contains(render.err, std::string("c/") + name + ": broken")) << render.err;
    }
    expect_exit(weft({"simulate", "s.toml", "--cache", "c", "--resume"}), 0, "starting at the beginning");
    EXPECT_EQ(hash_of_frames("c", kFrames), expected) << name;
  }
}

TEST_F(CachedRun, SecondProcessAtTheSamePlaceIsRefused) {
  {
    const cache::Lock cache(folder_ / "c"), working(folder_ / ".a.weft-cache");
    for (const Arguments& arguments :
         {Arguments{"simulate", "s.toml", "--cache", "c"}, Arguments{"run", "s.toml", "-o", "a.mp4"}}) {
      expect_exit(weft(arguments), 6, "another process writes it");
    }
  }
  expect_well({"run", "s.toml", "-o", "a.mp4"});
  EXPECT_FALSE(fs::exists(folder_ / ".a.weft-cache")) << "the working cache outlives a run that ended well";
}

class KilledRun : public CachedRun {
 protected:
  // Kills a run after the given number of frames.
  void kill_after(int frames) const {
    Subprocess process({"run", "s.toml", "-o", "a.mp4", "--meshes", "m", "--size", "64x36", "--quality", "draft",
                        "--progress", "none", "--log-json", "-"},
                       folder_, 0, Subprocess::Start::fork);
    ASSERT_TRUE(process.wait_for_output("\"frame\":" + std::to_string(frames) + ","));
    process.send(SIGKILL);
    EXPECT_EQ(process.wait().exit_code, 128 + SIGKILL);
  }
  Outcome resume() const { return weft({"run", "s.toml", "-o", "a.mp4", "--meshes", "m", "--resume"}); }
};

TEST_F(KilledRun, GoesOnToTheFramesAndMeshesOfTheUninterruptedOne) {
  expect_well({"run", "s.toml", "-o", "whole.mp4", "--meshes", "mw"});
  const std::string whole = decoded("whole.mp4");
  for (const int frame : {0, 12}) {
    kill_after(frame);
    EXPECT_FALSE(fs::exists(folder_ / "a.mp4")) << "a half file under the final name";
    EXPECT_TRUE(fs::exists(folder_ / ".a.weft-cache/state.weft"));
    expect_exit(resume(), 0);
    EXPECT_EQ(decoded("a.mp4"), whole);
    expect_same("m", "mw", ".ply", 3 * kFrames);
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << " was left";
    fs::remove(folder_ / "a.mp4");
    fs::remove_all(folder_ / "m");
  }
}

TEST_F(KilledRun, IsThrownAwayWithANoteByOneThatDoesNotResume) {
  kill_after(5);
  expect_exit(weft({"run", "s.toml", "-o", "a.mp4", "--meshes", "n"}), 0,
              "of an unfinished run are discarded; --resume");
}

TEST_F(KilledRun, WithNothingThereResumeStartsAtTheBeginning) {
  expect_exit(resume(), 0, "nothing to resume; starting at the beginning");
  const auto written = fs::last_write_time(folder_ / "a.mp4");
  fs::create_directory(folder_ / ".a.weft-cache");  // as if the run was killed while it removed the cache
  support::write_bytes(folder_ / ".a.weft-cache/frame_00003.weft", "\x89WEFT\r\n\x1A-");
  const Outcome again = resume();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "note: a.mp4 is complete already: frames 0:21\n");
  EXPECT_FALSE(fs::exists(folder_ / ".a.weft-cache"));
  EXPECT_EQ(fs::last_write_time(folder_ / "a.mp4"), written) << "a finished video was replaced";
  EXPECT_EQ(weft({"run", "s.toml", "-o", "a.mp4", "--resume", "--set", "time.duration=0.4"}).exit_code, 6)
      << "another film has this name";
}

TEST_F(KilledRun, ReplacesOnlyItsOwnOutputsWhenItGoesOn) {
  kill_after(5);
  support::write_bytes(folder_ / "precious.json", "precious");
  expect_exit(weft({"run", "s.toml", "-o", "a.mp4", "--meshes", "m", "--resume", "--stats", "precious.json"}), 6,
              "precious.json: exists already");
  EXPECT_EQ(support::read_bytes(folder_ / "precious.json"), "precious");
  EXPECT_EQ(resume().exit_code, 0);
}

TEST_F(KilledRun, GoesOnWithOtherLooksToTheVideoThatHasThemFromTheStart) {
  const Arguments run{"run", "s.toml", "-o", "a.mp4", "--set", "cloth.cloth.look.color=[1,0,0]"};
  kill_after(5);
  Arguments resumed = run;
  resumed.push_back("--resume");
  expect_exit(weft(resumed), 0, "only the look of the scene has changed; its simulation");
  const std::string pictures = decoded("a.mp4");
  fs::remove(folder_ / "a.mp4");
  expect_well(run);
  EXPECT_EQ(decoded("a.mp4"), pictures);
}

TEST_F(KilledRun, ThatWasEditedIsNotResumedAndNotLost) {
  kill_after(5);
  expect_exit(weft({"run", "s.toml", "-o", "a.mp4", "--meshes", "m", "--resume", "--set", "obstacle.ball.radius=0.11"}),
              6, "which has changed since");
  EXPECT_EQ(resume().exit_code, 0);
}

TEST_F(CachedRun, InterruptedByCtrlCRunGoesOnToTheWholeVideo) {
  expect_well({"run", "s.toml", "-o", "whole.mp4"});
  Subprocess process({"run", "s.toml", "-o", "a.mp4", "--size", "64x36", "--quality", "draft", "--progress", "none",
                      "--log-json", "-"},
                     folder_);
  ASSERT_TRUE(process.wait_for_output("\"frame\":3,"));
  process.send(SIGINT);
  const Outcome interrupted = process.wait();
  if (interrupted.exit_code == 0) GTEST_SKIP() << "it was done before the signal came";
  expect_exit(interrupted, 75, "the same command with --resume continues from there");
  EXPECT_LT(probe_video(folder_ / "a.mp4").frames, kFrames);
  expect_well({"run", "s.toml", "-o", "a.mp4", "--resume"});
  EXPECT_EQ(decoded("a.mp4"), decoded("whole.mp4"));
}

TEST_F(CachedRun, InterruptedWithinALongFrameSimulationKeepsTheFramesBefore) {
  // The second frame needs ten million steps.
  Subprocess process({"simulate", "s.toml", "--cache", "c", "--progress", "none", "--log-json", "-", "--set",
                      "time.step=1e-7", "--set", "time.fps=1", "--set", "time.duration=3"},
                     folder_);
  ASSERT_TRUE(process.wait_for_output("\"frame\":0,"));
  process.send(SIGTERM);
  const Outcome interrupted = process.wait();
  EXPECT_EQ(interrupted.exit_code, 75);
  // On a busy machine, the signal may arrive before the first step.
  EXPECT_TRUE(contains(interrupted.err, "interrupted within a time step") ||
              contains(interrupted.err, "interrupted after frame 0"))
      << interrupted.err;
  EXPECT_TRUE(contains(interrupted.err, "; 1 frame is kept in c; the same command with ")) << interrupted.err;
  EXPECT_EQ(cache::Reader(folder_ / "c").frames().size(), 1u);
}

TEST_F(CachedRun, FullDiskEndsASimulationButOnlyTheCacheOfARun) {
  const auto limited = [&](const Arguments& arguments, std::size_t bytes) {
    return Subprocess(joined(arguments, kSmall), folder_, bytes).wait();
  };
  expect_exit(limited({"simulate", "s.toml", "--cache", "c"}, 3000), 6, "cannot be written: File too large");
  // The limit of the file size allows pictures of a few kilobytes, but not states.
  const std::string camera = "camera=[{name='v',position=[1,-1,1],target=[0,0,0.2]}]";
  const Outcome run = limited({"run", "s.toml", "-o", std::string("p/") + kPictures, "--set", camera}, 8000);
  expect_exit(run, 0, "the run continues, but");
  EXPECT_EQ(contents("p", ".png").size(), static_cast<std::size_t>(kFrames));
  EXPECT_FALSE(fs::exists(folder_ / "p/.s.weft-cache"));
  // With a computed camera, pictures are drawn from the cache, so the run fails.
  EXPECT_EQ(limited({"run", "s.toml", "-o", std::string("q/") + kPictures}, 3000).exit_code, 6);
}

}  // namespace
}  // namespace weft::cli
