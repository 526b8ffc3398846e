// The program as users run it: exit codes, messages, and the files that exist afterwards.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/subprocess.hpp"
#include "cli/video_probe.hpp"
#include "core/version.hpp"
#include "film/image/png.hpp"
#include "support/ply.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

// Five frames of a handkerchief that falls past a ball and a floor; both are visible but do not collide.
constexpr const char* kFallPastBall = R"(
[time]
duration = 0.4
fps = 10
step = 0.02

[[cloth]]
name = "cloth"
size = [0.2, 0.2]
particles = [5, 4]
position = [0, 0, 0.3]

[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 8
collide = false

[[obstacle]]
name = "floor"
shape = "plane"
position = [0, 0, -0.1]
collide = false

[[camera]]
name = "front"
position = [0, -2, 0.3]
target = [0, 0, 0.1]
)";

class Program : public support::TestFolder {
 protected:
  void SetUp() override {
    support::TestFolder::SetUp();
    support::write_bytes(folder_ / "s.toml", kFallPastBall);
  }

  // Small and quick settings, followed by the options in `more`.
  Arguments run_arguments(const Arguments& more = {}) const { return joined(joined({"run", "s.toml"}, kSmall), more); }
  Outcome run(const Arguments& more = {}) const { return run_weft(run_arguments(more), folder_); }

  // All files below the folder, relative to it; for a working cache only the folder itself.
  std::set<std::string> tree() const {
    std::set<std::string> names;
    for (auto entry = fs::recursive_directory_iterator(folder_); entry != fs::recursive_directory_iterator(); ++entry) {
      const bool cache = entry->path().extension() == ".weft-cache";
      if (cache) entry.disable_recursion_pending();
      if (cache || entry->is_regular_file()) names.insert(fs::relative(entry->path(), folder_).string());
    }
    return names;
  }

  Json json(const char* file) const { return Json::parse(support::read_bytes(folder_ / file)); }
};

std::vector<Json> json_lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

TEST_F(Program, TurnsASceneIntoAVideoOfAllItsFramesUnderTheDefaultName) {
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "standard output belongs to machines";
  EXPECT_EQ(tree(), (std::set<std::string>{"output/s.effective.toml", "output/s.mp4", "s.toml"}));
  const VideoFacts video = probe_video(folder_ / "output/s.mp4");
  EXPECT_EQ(video.frames, 5);
  EXPECT_EQ(video.width, 64);
  EXPECT_EQ(video.height, 36);
  EXPECT_NEAR(video.duration, 0.5, 1e-3);  // five frames of 0.1 s; time base of the file: at least 1/1000 s
  EXPECT_EQ(video.metadata.at("weft_version"), kVersion);
  EXPECT_EQ(video.metadata.at("scene"), "s");
  EXPECT_EQ(video.metadata.at("scene_hash").size(), 16u);
  EXPECT_EQ(video.metadata.at("frames"), "0:5");
  EXPECT_FALSE(video.metadata.at("gl").empty());
  for (const char* word : {"output/s.mp4: 5 frames, 64x36 at 10 fps", "simulate", "draw", "encode", "20 in 3 objects",
                           "Newton", "smallest distance", "largest strain", "energy", "peak memory"}) {
    EXPECT_TRUE(contains(outcome.err, word)) << word << "\n" << outcome.err;
  }
}

TEST_F(Program, EffectiveSceneGivesTheSameSceneAgain) {
  ASSERT_EQ(run().exit_code, 0);
  const Outcome again = run_weft({"check", "output/s.effective.toml"}, folder_);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(contains(again.out, "1 cloth, 2 obstacles, 20 particles, 5 frames at 10 fps")) << again.out;
}

TEST_F(Program, DrawsOnlyTheWantedFramesAndKeepsTheTrueSpeed) {
  ASSERT_EQ(run({"--frames", "0:5:2", "-o", "a.mp4"}).exit_code, 0);
  const VideoFacts video = probe_video(folder_ / "a.mp4");
  EXPECT_EQ(video.frames, 3);
  EXPECT_NEAR(video.duration, 0.6, 1e-3);  // every second frame is shown twice as long
  EXPECT_EQ(run({"--frames", "0:6", "-o", "b.mp4"}).exit_code, 2);
}

TEST_F(Program, WritesNumberedPicturesThatSayWhatTheyShow) {
  const Outcome outcome = run({"-o", "out/{frame:03}.png", "--frames", "1:4", "--camera", "front"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(tree(),
            (std::set<std::string>{"out/001.png", "out/002.png", "out/003.png", "out/s.effective.toml", "s.toml"}));
  image::Metadata metadata;
  const image::Image image = image::read_png(folder_ / "out/002.png", &metadata);
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 36);
  EXPECT_EQ(metadata.at("frame"), "2");
  EXPECT_EQ(metadata.at("time_s"), "0.2");
  EXPECT_EQ(metadata.at("camera"), "front");
  EXPECT_EQ(metadata.at("quality"), "draft");
  EXPECT_EQ(metadata.at("weft_version"), kVersion);
}

TEST_F(Program, StatsHoldEveryNamedKeyForEveryFrame) {
  const Outcome outcome = run({"--stats", "stats/s.json", "--threads", "1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json stats = json("stats/s.json");
  EXPECT_EQ(stats.at("scene"), "s");
  EXPECT_EQ(stats.at("version"), kVersion);
  EXPECT_EQ(stats.at("threads"), 1);
  EXPECT_TRUE(stats.at("cpu").is_string());
  EXPECT_GT(stats.at("peak_memory_bytes"), 1'000'000);
  ASSERT_EQ(stats.at("objects").size(), 3u);
  EXPECT_EQ(stats.at("objects")[0].at("name"), "cloth");
  EXPECT_EQ(stats.at("objects")[0].at("kind"), "cloth");
  EXPECT_EQ(stats.at("objects")[0].at("vertices"), 20);
  EXPECT_EQ(stats.at("objects")[1].at("kind"), "obstacle");
  EXPECT_GT(stats.at("objects")[1].at("faces"), 0);
  for (const char* key : {"simulate", "collide", "render", "encode", "wall", "simulate_cpu", "collide_cpu",
                          "render_cpu", "encode_cpu", "cpu"}) {
    EXPECT_GE(stats.at("totals").at(key), 0) << key;
  }
  ASSERT_EQ(stats.at("frames").size(), 5u);
  double render_ms = 0;
  for (int k = 0; k < 5; ++k) {
    const Json& frame = stats.at("frames").at(static_cast<std::size_t>(k));
    EXPECT_EQ(frame.at("frame"), k);
    EXPECT_DOUBLE_EQ(frame.at("time_s"), k / 10.0);
    EXPECT_EQ(frame.at("steps"), k == 0 ? 0 : 5);  // 0.1 s in steps of 0.02 s
    for (const char* key :
         {"simulate_ms", "collide_ms", "encode_ms", "rejected_steps", "newton_iterations", "linear_iterations",
          "proximities", "constraints", "max_strain", "kinetic_energy_j", "elastic_energy_j"}) {
      EXPECT_TRUE(frame.at(key).is_number()) << key;
    }
    EXPECT_TRUE(frame.at("min_distance_m").is_number() || frame.at("min_distance_m").is_null());
    EXPECT_GT(frame.at("render_ms"), 0);
    render_ms += frame.at("render_ms").get<double>();
  }
  EXPECT_NEAR(stats.at("totals").at("render"), render_ms / 1e3, 1e-9);  // tolerance: rounding of a sum of five
}

TEST_F(Program, LogIsOneJsonObjectALine) {
  const Outcome outcome = run({"--log-json", "-", "--frames", "2:5"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::map<std::string, int> events;
  std::set<int> frames, written;
  for (const Json& line : json_lines(outcome.out)) {
    ++events[line.at("event")];
    if (line.at("event") != "frame_done") continue;
    frames.insert(line.at("frame").get<int>());
    if (line.at("written")) written.insert(line.at("frame").get<int>());
  }
  EXPECT_EQ(events, (std::map<std::string, int>{
                        {"scene_loaded", 1}, {"simulation_ready", 1}, {"frame_done", 5}, {"finished", 1}}));
  EXPECT_EQ(frames, (std::set<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(written, (std::set<int>{2, 3, 4}));
  ASSERT_EQ(run({"--log-json", "log/run.jsonl", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(json_lines(support::read_bytes(folder_ / "log/run.jsonl")).back().at("exit_code"), 0);
}

TEST_F(Program, MeshesHoldEachObjectOfEachDrawnFrame) {
  const Outcome outcome = run({"--meshes", "m", "--frames", "0:5:4"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::set<std::string> meshes;
  for (const auto& entry : fs::directory_iterator(folder_ / "m")) meshes.insert(entry.path().filename());
  EXPECT_EQ(meshes, (std::set<std::string>{"ball_00000.ply", "ball_00004.ply", "cloth_00000.ply", "cloth_00004.ply",
                                           "floor_00000.ply", "floor_00004.ply"}));
  const support::PlyMesh start = support::read_ply(folder_ / "m/cloth_00000.ply");
  EXPECT_EQ(start.positions.size(), 20u);
  EXPECT_EQ(start.triangles.size(), 24u);  // 4 by 3 quads, each split in two
  const support::PlyMesh end = support::read_ply(folder_ / "m/cloth_00004.ply");
  EXPECT_LT(end.positions[0].z(), start.positions[0].z() - 0.05) << "the cloth did not fall";
  expect_exit(run({"--meshes", "m", "--frames", "0:1", "-o", "other.mp4"}), 6, "m/cloth_00000.ply: exists already");
}

TEST_F(Program, RefusesToReplaceAVideoUnlessTold) {
  support::write_bytes(folder_ / "a.mp4", "precious");
  const Outcome refused = run({"-o", "a.mp4", "--log-json", "-"});
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_EQ(refused.err, "weft: a.mp4: exists already; give --overwrite to replace it, or another name\n");
  EXPECT_FALSE(contains(refused.out, "simulation_ready")) << "simulated before refusing";
  EXPECT_EQ(support::read_bytes(folder_ / "a.mp4"), "precious");
  EXPECT_EQ(run({"-o", "a.mp4", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(probe_video(folder_ / "a.mp4").frames, 5);
}

TEST_F(Program, OutputThatCannotBeWrittenIsRefusedBeforeSimulating) {
  support::write_bytes(folder_ / "plain", "");
  for (const char* output : {"plain/a.mp4", "/proc/weft/a.mp4", "/dev/full/a.mp4"}) {
    const Outcome outcome = run({"-o", output, "--log-json", "-"});
    EXPECT_EQ(outcome.exit_code, 6) << output;
    EXPECT_TRUE(contains(outcome.err, output)) << outcome.err;
    EXPECT_FALSE(contains(outcome.out, "simulation_ready"));
  }
  EXPECT_EQ(run({"-o", ".mp4/"}).exit_code, 2);
  EXPECT_EQ(run({"--stats", "plain/s.json"}).exit_code, 6);
  EXPECT_EQ(run({"--meshes", "plain"}).exit_code, 6);
  EXPECT_EQ(run({"--log-json", "plain/l"}).exit_code, 6);
  EXPECT_EQ(tree(), (std::set<std::string>{"plain", "s.toml"}));
}

TEST_F(Program, DiskThatFillsUpLeavesNoHalfVideo) {
  expect_exit(Subprocess(run_arguments({"-o", "a.mp4"}), folder_, 500).wait(), 6,
              "File too large; no frame was written");
  EXPECT_EQ(tree(), std::set<std::string>{"s.toml"});
}

TEST_F(Program, OverridesAreCheckedLikeTheFile) {
  EXPECT_EQ(run({"--set", "cloth.cloth.particles=[3,3]", "--stats", "s.json"}).exit_code, 0);
  EXPECT_EQ(json("s.json").at("particles"), 9);
  expect_exit(run({"--set", "time.fps=-1"}), 3, "time.fps");
  EXPECT_EQ(run({"--fps", "20", "-o", "f.mp4"}).exit_code, 0);
  EXPECT_EQ(probe_video(folder_ / "f.mp4").frames, 9);
}

TEST_F(Program, UsageErrorsExitWith2AndNameTheNearest) {
  EXPECT_EQ(run_weft({}, folder_).exit_code, 2);
  EXPECT_EQ(run_weft({"rnu", "s.toml"}, folder_).exit_code, 2);
  EXPECT_EQ(run_weft({"simulate", "s.toml"}, folder_).exit_code, 2);
  EXPECT_EQ(run({"--quality", "best"}).exit_code, 2);
  const Outcome camera = run({"--camera", "frnot"});
  EXPECT_EQ(camera.exit_code, 2);
  EXPECT_EQ(camera.err, "weft: --camera: expected front, got frnot; did you mean front?\n");
  EXPECT_EQ(tree(), std::set<std::string>{"s.toml"});
}

TEST_F(Program, VersionAndHelpGoToStandardOutput) {
  const Outcome version = run_weft({"--version"}, folder_);
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, std::string("weft ") + kVersion + "\n");
  const Outcome help = run_weft({"--help"}, folder_);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_TRUE(contains(help.out, "thumbnail") && contains(help.out, "Examples"));
}

TEST(Version, IsThatOfTheBuild) {
  const std::string cmake = support::read_bytes(fs::path(WEFT_SOURCE_DIR) / "CMakeLists.txt");
  EXPECT_TRUE(contains(cmake, std::string("project(weft VERSION ") + kVersion + " "));
}

TEST_F(Program, CheckPrintsAllMistakesOfAllScenesAndExitsWith3) {
  support::write_bytes(folder_ / "bad.toml", "[time]\nduraton = 3\nfps = -1\n[[cloth]]\nname = 'a'\n");
  support::write_bytes(folder_ / "worse.toml", "[time\n");
  const Outcome outcome = run_weft({"check", "bad.toml", "s.toml", "worse.toml", "none.toml"}, folder_);
  expect_exit(outcome, 3, "bad.toml:2:1: time.duraton: unknown key; did you mean duration?");
  EXPECT_TRUE(contains(outcome.err, "bad.toml:3:")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "worse.toml:1:")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "none.toml")) << outcome.err;
  EXPECT_FALSE(contains(outcome.err, "\n\n")) << outcome.err;
  EXPECT_EQ(outcome.out, "s.toml: ok: 1 cloth, 2 obstacles, 20 particles, 5 frames at 10 fps\n");
}

constexpr const char* kSack = R"(
[[panel]]
name = "front"
path = "M -0.2 0 L 0.2 0 L 0.2 0.3 L -0.2 0.3 Z"
edges = "hem right top left"
[[panel]]
name = "back"
side = "back"
file = "back.svg"
id = "back"
edges = "hem right top left"
[[seam]]
a = "front.left"
b = "back.left"
[[seam]]
a = "front.right"
b = "back.right"
)";
constexpr const char* kDrawing =
    "<svg width='400mm' viewBox='-200 -300 400 300'>\n<path id='back' d='M-200 0H200V-300H-200Z'/></svg>";

TEST_F(Program, CheckReadsPatternsAndTheirDrawings) {
  const std::string cloth = "[[cloth]]\nname = 'sack'\nshape = 'pattern'\nfile = 'sack.toml'\nedge_length = 0.1\n";
  const auto put = [&](const std::string& scene, const std::string& pattern, const std::string& drawing) {
    support::write_bytes(folder_ / "dressed.toml", scene + "[time]\nduration = 1\nfps = 10\n");
    support::write_bytes(folder_ / "sack.toml", pattern);
    support::write_bytes(folder_ / "back.svg", drawing);
  };
  const auto damaged = [](std::string text, const std::string& good, const std::string& bad) {
    return text.replace(text.find(good), good.size(), bad);
  };
  // Two panels of 5 by 4 points; the 4 points of each sewn side are shared.
  put(cloth, kSack, kDrawing);
  for (const bool plan : {false, true}) {
    const Outcome good =
        run_weft(plan ? Arguments{"check", "--plan", "dressed.toml"} : Arguments{"check", "dressed.toml"}, folder_);
    EXPECT_EQ(good.exit_code, 0) << good.err;
    EXPECT_TRUE(contains(good.out, "dressed.toml: ok: 1 cloth, 0 obstacles, 32 particles, 11 frames at 10 fps\n"))
        << good.out;
  }
  // Mistakes of all three files at once.
  const std::string pattern = damaged(kSack, "front.left", "front.lft") + "[[hem]]\nedge = 'front.hem'\nmass = -1\n";
  put(damaged(cloth, "0.1", "-1"), pattern, damaged(kDrawing, "V-300", "W-300"));
  const Outcome bad = run_weft({"check", "dressed.toml"}, folder_);
  expect_exit(bad, 3, "dressed.toml:5:15: cloth.sack.edge_length");
  EXPECT_TRUE(contains(bad.err, "sack.toml:20:8: hem.0.mass")) << bad.err;
  EXPECT_TRUE(contains(bad.err, "back.svg:2:2: path \"back\": ")) << bad.err;
  EXPECT_EQ(bad.out, "");
  // If the panels can be drawn, the check covers the names of edges too.
  put(cloth, pattern, kDrawing);
  EXPECT_TRUE(contains(run_weft({"check", "dressed.toml"}, folder_).err, "sack.toml:13:5: seam.0.a: expected an edge"));
  // A mistake in the drawing alone is an asset error. Mistakes that only sewing finds are reported too.
  put(cloth, kSack, damaged(kDrawing, "'back'", "'bck'"));
  EXPECT_EQ(run_weft({"check", "dressed.toml"}, folder_).exit_code, 4);
  put(cloth, damaged(kSack, "side = \"back\"", "rotation = 180"), kDrawing);
  const Outcome turned = run_weft({"check", "dressed.toml", "s.toml"}, folder_);
  expect_exit(turned, 3, "cloth.sack: pattern ");
  EXPECT_TRUE(contains(turned.out, "s.toml: ok")) << turned.out;
}

TEST_F(Program, PlanNamesWhatIsLeftOut) {
  const Outcome with = run_weft({"check", "--plan", "s.toml"}, folder_);
  const Outcome without = run_weft(
      {"check", "--plan", "s.toml", "--set", "contact.self=false", "--set", "contact.obstacles=false"}, folder_);
  EXPECT_EQ(with.exit_code, 0);
  EXPECT_TRUE(contains(with.out, "\n  uses ")) << with.out;
  EXPECT_TRUE(contains(without.out, "\n  leaves out ")) << without.out;
  EXPECT_NE(with.out, without.out);
  const Outcome prepared =
      run_weft({"check", "--plan", "s.toml", "--set", "time.preroll=0.2", "--set", "time.tolerance=0.001"}, folder_);
  EXPECT_TRUE(contains(with.out, "time.preroll is 0")) << with.out;
  EXPECT_TRUE(contains(prepared.out, "2 frames before the first")) << prepared.out;
  EXPECT_TRUE(contains(prepared.out, "error of a step 0.001 m")) << prepared.out;
}

TEST_F(Program, ThumbnailDrawsTheFrameThatWasAskedFor) {
  const auto thumbnail = [&](const Arguments& more) {
    return run_weft(joined(joined({"thumbnail", "s.toml"}, more), kSmall), folder_);
  };
  EXPECT_EQ(thumbnail({"--frame", "2"}).exit_code, 0);
  EXPECT_EQ(thumbnail({"-o", "end.png", "--frame", "4"}).exit_code, 0);
  image::Metadata middle, end;
  const image::Image a = image::read_png(folder_ / "output/s.png", &middle);
  const image::Image b = image::read_png(folder_ / "end.png", &end);
  EXPECT_EQ(middle.at("frame"), "2");
  EXPECT_EQ(end.at("frame"), "4");
  EXPECT_NE(a.rgb, b.rgb) << "the cloth fell in between";
  EXPECT_EQ(thumbnail({"-o", "end.png"}).exit_code, 6);
  EXPECT_EQ(thumbnail({"-o", "end.jpg"}).exit_code, 2);
  EXPECT_EQ(thumbnail({"-o", "x.png", "--frame", "5"}).exit_code, 2);
}

TEST_F(Program, ThumbnailEqualsThatFrameOfARun) {
  ASSERT_EQ(run({"-o", "{frame}.png"}).exit_code, 0);
  const Arguments arguments{"thumbnail", "s.toml", "-o", "t.png", "--frame", "3", "--camera", "front"};
  ASSERT_EQ(run_weft(joined(arguments, kSmall), folder_).exit_code, 0);
  EXPECT_EQ(image::read_png(folder_ / "t.png").rgb, image::read_png(folder_ / "3.png").rgb);
}

TEST_F(Program, SchemaIsJson) {
  const Outcome outcome = run_weft({"schema"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(Json::parse(outcome.out).at("properties").contains("cloth"));
}

TEST_F(Program, DoctorTriesThisMachineAndLeavesNothingBehind) {
  const Outcome outcome = run_weft({"doctor"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  for (const char* word : {"processor", "x86-64", "threads", "OpenGL", "encoder", "ok  encoding", "ok  drawing"}) {
    EXPECT_TRUE(contains(outcome.out, word)) << word << "\n" << outcome.out;
  }
  EXPECT_EQ(tree(), std::set<std::string>{"s.toml"});
}

TEST_F(Program, FailedSimulationKeepsAllFramesBefore) {
  // One Newton iteration without shorter steps is enough in free fall, but not when the cloth touches the ball.
  const Outcome outcome = run({"-o", "a.mp4", "--stats", "s.json", "--set", "solver.newton_iterations=1", "--set",
                               "solver.halvings=0", "--set", "obstacle.ball.collide=true", "--set",
                               "solver.newton_tolerance=1e-9", "--set", "solver.linear_tolerance=1e-12"});
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  const Json stats = json("s.json");
  const int frames = static_cast<int>(stats.at("frames").size());
  EXPECT_GE(frames, 1);
  EXPECT_LT(frames, 5);
  EXPECT_EQ(probe_video(folder_ / "a.mp4").frames, frames);
  EXPECT_EQ(stats.at("exit_code"), 5);
  EXPECT_TRUE(contains(outcome.err, "the simulation failed")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "kept in a.mp4")) << outcome.err;
}

class Interrupted : public Program {
 protected:
  // Arguments for an hour of video, so that the run cannot end by itself.
  Arguments endless(const Arguments& more) const {
    return run_arguments(joined({"--set", "time.duration=3600", "--log-json", "-"}, more));
  }
};

TEST_F(Interrupted, BySigtermClosesAPlayableVideoAndExitsWith75) {
  Subprocess weft(endless({"-o", "a.mp4", "--stats", "s.json"}), folder_);
  ASSERT_TRUE(weft.wait_for_output("\"frame\":2,"));
  weft.send(SIGTERM);
  weft.send(SIGTERM);  // as timeout(1) does: once to the process, once to its group
  const Outcome outcome = weft.wait();
  EXPECT_EQ(outcome.exit_code, 75) << outcome.err;
  const Json stats = json("s.json");
  const int frames = probe_video(folder_ / "a.mp4").frames;
  EXPECT_GE(frames, 3);
  EXPECT_EQ(static_cast<std::size_t>(frames), stats.at("frames").size());
  EXPECT_EQ(stats.at("exit_code"), 75);
  EXPECT_TRUE(contains(outcome.err, fmt::format("{} frames are kept in a.mp4", frames))) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "the same command with --resume continues from there")) << outcome.err;
  EXPECT_EQ(tree(), (std::set<std::string>{".a.weft-cache", "a.mp4", "a.effective.toml", "s.json", "s.toml"}));
}

TEST_F(Interrupted, ByCtrlCKeepsWholePictures) {
  Subprocess weft(endless({"-o", "{frame}.png"}), folder_);
  ASSERT_TRUE(weft.wait_for_output("\"frame\":1,"));
  weft.send(SIGINT);
  EXPECT_EQ(weft.wait().exit_code, 75);
  int pictures = 0;
  for (const std::string& name : tree()) {
    EXPECT_FALSE(name.ends_with(".tmp")) << name;
    if (!name.ends_with(".png")) continue;
    ++pictures;
    EXPECT_EQ(image::read_png(folder_ / name).width, 64) << name;
  }
  EXPECT_GE(pictures, 2);
}

TEST_F(Interrupted, TwiceQuitsAtOnceAndRemovesWhatIsHalfWritten) {
  // The first frame takes ten million steps, so it cannot be finished during the test.
  Subprocess weft(endless({"-o", "a.mp4", "--set", "time.step=1e-7", "--set", "time.fps=1"}), folder_);
  ASSERT_TRUE(weft.wait_for_output("\"frame\":0,"));
  weft.send(SIGINT);
  ASSERT_TRUE(weft.wait_for_output("finishing the current frame"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // signals within a second count as one
  weft.send(SIGINT);
  expect_exit(weft.wait(), 75, "quit at once");
  EXPECT_EQ(tree(), (std::set<std::string>{".a.weft-cache", "s.toml"}));
}

}  // namespace
}  // namespace weft::cli
