// Files lie in the way of a command, or are put there while it works. Then no foreign file is lost, nothing crashes or
// hangs, and no input is reported as an internal error.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>

#include "cli/cached_run.hpp"
#include "film/cache/container.hpp"
#include "film/image/png.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class NothingLost : public CachedRun {
 protected:
  Arguments with(const Arguments& arguments) const { return joined(joined(arguments, kSmall), {"--log-json", "-"}); }

  /// Starts the command, calls `disturb` while it works, and waits for its end.
  Outcome disturbed(const Arguments& arguments, const std::function<void()>& disturb) const {
    Subprocess process(with(arguments), folder_);
    EXPECT_TRUE(process.wait_for_output("\"frame\":3,"));
    disturb();
    return process.wait();
  }

  void write(const std::string& file, const std::string& content = "precious") const {
    fs::create_directories((folder_ / file).parent_path());
    support::write_bytes(folder_ / file, content);
  }
  void expect_kept(const std::string& file) const {
    ASSERT_TRUE(fs::exists(folder_ / file)) << file;
    EXPECT_EQ(support::read_bytes(folder_ / file), "precious") << file;
  }
};

TEST_F(NothingLost, AFileThatAppearsWhileARunWorksStays) {
  for (const char* file : {"v/a.mp4", "v/a.effective.toml", "s.json", "m/cloth_00020.ply"}) {
    for (const char* output : {"v", "s.json", "m"}) fs::remove_all(folder_ / output);
    const Outcome outcome =
        disturbed({"run", "s.toml", "-o", "v/a.mp4", "--stats", "s.json", "--meshes", "m"}, [&] { write(file); });
    EXPECT_EQ(outcome.exit_code, 6) << file;
    EXPECT_TRUE(contains(outcome.err, "was made by somebody else while this command worked")) << outcome.err;
    expect_kept(file);
  }
  expect_exit(disturbed({"run", "s.toml", "-o", "p/{frame:05}.png"}, [&] { write("p/00020.png"); }), 6);
  expect_kept("p/00020.png");
  EXPECT_TRUE(fs::exists(folder_ / "p/00019.png"));
}

TEST_F(NothingLost, AVideoThatCannotHaveItsNameIsKeptUnderAnother) {
  const Outcome outcome = disturbed({"run", "s.toml", "-o", "a.mp4"}, [&] { write("a.mp4"); });
  EXPECT_TRUE(contains(outcome.err, "all 21 frames are kept in a.partial.mp4")) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "a.partial.mp4"));
  // The next run that completes the video removes its own a.partial.mp4, but no file of others.
  fs::remove(folder_ / "a.mp4");
  write("b.partial.mp4");
  for (const char* video : {"a.mp4", "b.mp4"}) expect_well({"run", "s.toml", "-o", video, "--overwrite"});
  EXPECT_FALSE(fs::exists(folder_ / "a.partial.mp4"));
  expect_kept("b.partial.mp4");
}

TEST_F(NothingLost, ARunThatIsGoneOnWithReplacesItsOwnOutputsOnly) {
  const Arguments run{"run", "s.toml", "-o", "a.mp4", "--stats", "s.json", "--meshes", "m"};
  Subprocess process(with(run), folder_);
  ASSERT_TRUE(process.wait_for_output("\"frame\":3,"));
  process.send(SIGINT);
  if (process.wait().exit_code == 0) GTEST_SKIP() << "it was done before the signal came";
  Arguments resumed = run;
  resumed.push_back("--resume");
  for (const char* file : {"a.mp4", "a.effective.toml", "s.json", "m/cloth_00002.ply"}) {
    const std::string own = support::read_bytes(folder_ / file);
    write(file);
    const Outcome outcome = run_weft(with(resumed), folder_);
    EXPECT_EQ(outcome.exit_code, 6) << file << outcome.err;
    expect_kept(file);
    write(file, own);
  }
  resumed.insert(resumed.end(), {"--set", "cloth.cloth.look.color=[1,0,0]"});  // changes the effective scene
  expect_exit(run_weft(with(resumed), folder_), 0);
}

TEST_F(NothingLost, OverwriteRemovesOnlyWhatALongerRunHasWritten) {
  const Arguments run{"run", "s.toml", "-o", "p/p_{frame:05}.png", "--meshes", "m", "--overwrite"};
  expect_well(run);
  expect_well({"thumbnail", "s.toml", "--frame", "5", "-o", "p/p_00055.png"});
  const std::string thumbnail = support::read_bytes(folder_ / "p/p_00055.png");
  const std::vector<std::string> foreign{"p/p_00007.png", "p/p_99999.png", "m/cloth_00007.ply", "m/cloth_00099.ply"};
  for (const std::string& file : foreign) write(file);
  Arguments short_run{"run", "s.toml",      "-o",    "p/p_{frame:05}.png", "--meshes",
                      "m",   "--overwrite", "--set", "time.duration=0.2"};
  expect_well(short_run);
  for (const std::string& file : foreign) expect_kept(file);
  EXPECT_EQ(support::read_bytes(folder_ / "p/p_00055.png"), thumbnail) << "frame 5 under another number";
  EXPECT_FALSE(fs::exists(folder_ / "p/p_00008.png"));
  EXPECT_FALSE(fs::exists(folder_ / "m/cloth_00008.ply"));
}

// --frames ::2 selects a part of the film, so the other frames may be the results of another run.
TEST_F(NothingLost, EachSecondFrameWithOverwriteLeavesTheOthers) {
  ASSERT_EQ(run_weft(with({"run", "s.toml", "-o", "p/{frame:05}.png", "--meshes", "m", "--frames", "0:4"}), folder_)
                .exit_code,
            0);
  const std::string second = support::read_bytes(folder_ / "p/00001.png");
  const Outcome outcome = run_weft(
      with({"run", "s.toml", "-o", "p/{frame:05}.png", "--meshes", "m", "--frames", "::2", "--overwrite"}), folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* file : {"p/00001.png", "p/00003.png", "m/cloth_00001.ply"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  EXPECT_EQ(support::read_bytes(folder_ / "p/00001.png"), second);
}

// The frames after the first missing one may be good ones of an earlier command.
TEST_F(NothingLost, PartialWithOverwriteLeavesTheFramesThatItDoesNotMake) {
  const Arguments render{"render", "c", "-o", "p/{frame:05}.png", "--meshes", "m"},
      exported{"export", "c", "--format", "ply", "-o", "e"};
  const auto make = [&](const Arguments& more) {
    for (const Arguments& command : {render, exported}) {
      const Arguments arguments = joined(command, more);
      expect_exit(command == render ? weft(arguments) : run_weft(arguments, folder_), 0);
    }
  };
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":3"});
  make({"--frames", ":3"});
  fs::remove(folder_ / "c/frame_00001.weft");
  make({"--partial", "--overwrite"});
  for (const char* file : {"p/00001.png", "p/00002.png", "m/cloth_00002.ply", "e/cloth_00002.ply"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
}

TEST_F(NothingLost, AFolderThatIsRemovedWhileARunWorksEndsTheRun) {
  for (const Arguments& run :
       {Arguments{"run", "s.toml", "-o", "d/p/{frame:05}.png"}, Arguments{"run", "s.toml", "-o", "d/a.mp4"},
        Arguments{"simulate", "s.toml", "--cache", "d/c"},
        Arguments{"run", "s.toml", "-o", "a.mp4", "--meshes", "d/m", "--overwrite"}}) {
    const Outcome outcome = disturbed(run, [&] { fs::rename(folder_ / "d", folder_ / "gone"); });
    EXPECT_EQ(outcome.exit_code, 6) << run[3] << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "No such file or directory")) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "d")) << run[3];
    EXPECT_FALSE(contains(outcome.err, "kept in d")) << outcome.err;
    fs::remove_all(folder_ / "gone");
  }
}

// Without a check, the lock file of the cache would get the descriptor of the closed stream, and thus the messages.
TEST_F(NothingLost, MessagesForAClosedStreamAreWrittenIntoNoFile) {
  const auto simulate = [&](const std::string& cache, const std::string& more) {
    return WEXITSTATUS(std::system(fmt::format("cd '{}' && '{}' simulate s.toml --frames :2 --cache {} {}",
                                               folder_.string(), WEFT_PROGRAM, cache, more)
                                       .c_str()));
  };
  EXPECT_EQ(simulate("c", "--progress none 2>&-"), 0);
  EXPECT_EQ(fs::file_size(folder_ / "c/lock"), 0u) << support::read_bytes(folder_ / "c/lock");
  EXPECT_EQ(simulate("d", "--log-json - >&- 2>err"), 6);
  EXPECT_EQ(fs::file_size(folder_ / "d/lock"), 0u) << support::read_bytes(folder_ / "d/lock");
}

/// Inputs that are no regular files, or whose content is extreme or damaged.
class AnyInput : public NothingLost {
 protected:
  void SetUp() override {
    NothingLost::SetUp();
    write("o.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    image::write_png(folder_ / "a.png", image::Image(16, 16));
    expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":3"});
  }
  /// Exit code 0 means success, 1 an internal error, more than 128 a crash; the test expects none of them.
  void expect_refused(const Arguments& arguments, const std::string& about = "") const {
    const Outcome outcome = run_weft(arguments, folder_);
    EXPECT_TRUE(outcome.exit_code > 1 && outcome.exit_code < 128)
        << fmt::format("{}", fmt::join(arguments, " ")).substr(0, 200) << ": exit code " << outcome.exit_code << "\n"
        << outcome.err.substr(0, 2000);
    EXPECT_TRUE(about.empty() || contains(outcome.err + outcome.out, about))
        << about << ": " << outcome.err.substr(0, 2000);
  }
};

TEST_F(AnyInput, ThatIsAPipeOrAnEndlessDeviceIsRefusedWithoutWaiting) {
  for (const char* pipe : {"pipe", "pipe.toml", "pipe.csv", "pipe.json", "pipe.png", "pipe.mp4", "pipe.obj", "pipe.svg",
                           "pipe.mtl", "pipe.bin", "r/index.html", "r/b.json", "q/manifest.json", "f/b.png"}) {
    fs::create_directories((folder_ / pipe).parent_path());
    ASSERT_EQ(::mkfifo((folder_ / pipe).c_str(), 0666), 0);
  }
  for (const char* ending : {"toml", "csv", "json", "png", "mp4", "obj", "svg"})
    fs::create_symlink("/dev/zero", folder_ / (std::string("zero.") + ending));
  for (const std::string kind : {"pipe.", "zero."}) {
    expect_refused({"check", kind + "toml"});
    expect_refused({"sweep", "s.toml", "--list", kind + "csv", "-o", "w"}, "device or pipe");
    expect_refused({"sweep", "s.toml", "--list", kind + "toml", "-o", "w"}, "device or pipe");
    expect_refused({"diff", "a.png", kind + "png"}, kind + "png");
    expect_refused({"diff", "a.png", kind + "mp4"}, kind);
    expect_refused({"diff", "a.png", "a.png", "--limits", kind + "toml"}, "device or pipe");
    expect_refused({"accept", "a.png", kind + "png", "--reason", "why"});
    expect_refused({"thumbnail", "s.toml", "-o", "t.png", "--set", "cloth.cloth.look.image=" + kind + "png"});
    expect_refused({"check", "s.toml", "--set", "cloth.cloth.shape=mesh", "--set", "cloth.cloth.file=" + kind + "obj"});
  }
  write("m.toml",
        "[[obstacle]]\nname = 'o'\nshape = 'mesh'\nfile = 'm.obj'\n[[cloth]]\nname = 'c'\nposition=[0,0,3]\n");
  write("m.obj", "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
  EXPECT_EQ(run_weft({"check", "m.toml"}, folder_).exit_code, 0) << "a mesh does without its colours";
  write("m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"pipe.bin","byteLength":36}]})");
  expect_refused({"check", "m.toml", "--set", "obstacle.o.file=m.gltf"}, "m.gltf");
  fs::remove(folder_ / "c/frame_00001.weft");
  ASSERT_EQ(::mkfifo((folder_ / "c/frame_00001.weft").c_str(), 0666), 0);
  expect_refused({"render", "c", "-o", "x.mp4"});
  fs::remove(folder_ / "c/manifest.json");
  ASSERT_EQ(::mkfifo((folder_ / "c/manifest.json").c_str(), 0666), 0);
  expect_refused({"render", "c", "-o", "x.mp4"});
  expect_refused({"review", "r", "-o", "page"});
  expect_refused({"diff", "f", "f"});
}

TEST_F(AnyInput, ThatNestsTooDeepIsRefused) {
  const auto repeated = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const std::string key = repeated("\"a,\".", 100'000) + "a", list = repeated("[", 200'000);
  write("key.toml", key + " = 1\n");
  write("limits.toml", "[[picture]]\nname = 'a'\n" + key + " = 1\n");
  write("list.toml", "[[run]]\n" + key + " = 1\n");
  write("list.csv", repeated("a.", 60'000) + "a\n1\n");
  write("g.json", list);
  write("g.toml", "[[cloth]]\nname = 'c'\nshape = 'pattern'\nfile = 'g.json'\n");
  expect_refused({"check", "key.toml"}, "128 levels");
  expect_refused({"check", "s.toml", "--set", "time={" + repeated("a.", 30'000) + "a=1}"});
  expect_refused({"diff", "a.png", "a.png", "--limits", "limits.toml"}, "limits.toml");
  expect_refused({"sweep", "s.toml", "--list", "list.toml", "-o", "w"}, "list.toml");
  expect_refused({"sweep", "s.toml", "--list", "list.csv", "-o", "w"});
  expect_refused({"check", "g.toml"}, "128 levels");
  write("c/manifest.json", "{\"format\": " + list);
  expect_refused({"render", "c", "-o", "x.mp4"}, "128 levels");
  // A review page shows the files that it can read.
  for (const char* file : {"r/b.json", "r/sweep.json", "r/review.json"}) write(file, "{\"scene\": " + list);
  image::write_png(folder_ / "r/p_1.png", image::Image(16, 16));
  image::write_png(folder_ / "r/p_2.png", image::Image(16, 16));
  const Outcome page = run_weft({"review", "r", "-o", "page"}, folder_);
  EXPECT_EQ(page.exit_code, 0) << page.err.substr(0, 2000);
}

TEST_F(AnyInput, JsonWithValuesOfOtherTypesCausesNoInternalError) {
  const auto filled = [](std::string text, const std::string& value) {
    for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos; at += value.size())
      text.replace(at, 1, value);
    return text;
  };
  const std::string run = R"({"folder": "a", "scene": "s", "simulated_frames": @, "set": @})";
  for (const char* value : {"null", "true", "-1", "1e308", "18446744073709551615", "\"x\"", "[]", "{}", "[[1]]"}) {
    for (const std::string& index : std::vector<std::string>{
             R"({"options": @, "runs": [{"folder": @, "scene": @, "drawn_frames": @, "set": @}, @]})",
             R"({"options": [], "runs": @})", R"({"options": @, "runs": []})",
             R"({"options": [@], "runs": [)" + run + "]}"}) {
      write("w/sweep.json", filled(index, value));
      write("w/a/s.json", filled(R"({"scene": @, "exit_code": @, "scene_hash": @, "frames": @, "totals": @})", value));
      write("w/a/s.mp4");
      const Outcome status = run_weft({"farm", "status", "w"}, folder_);
      EXPECT_TRUE(status.exit_code == 0 || status.exit_code == 4 || status.exit_code == 9)
          << index << value << status.err;
      expect_refused({"sweep", "s.toml", "--set", "title=a,b", "-o", "w", "--size", "16x16"}, "with other options");
    }
    write("w/sweep.json", R"({"options": [], "runs": []})");
    write("w/title=a/s.json",
          filled(R"({"scene": "s", "exit_code": @, "frames": [{"newton_iterations": @}, @]})", value));
    expect_refused({"sweep", "s.toml", "--set", "title=a,b", "-o", "w", "--report"});
  }
}

TEST_F(AnyInput, ThatIsNoPathCausesNoInternalError) {
  const std::string longest(5000, 'x');
  for (const std::string& path : {std::string(), longest, longest + ".toml", longest + ".png", longest + "/x.mp4"}) {
    for (const Arguments& arguments : {Arguments{"check", path},
                                       Arguments{"run", path},
                                       Arguments{"run", "s.toml", "-o", path},
                                       Arguments{"simulate", "s.toml", "--cache", path},
                                       Arguments{"run", "s.toml", "-o", "a.mp4", "--stats", path},
                                       Arguments{"run", "s.toml", "-o", "a.mp4", "--meshes", path},
                                       Arguments{"run", "s.toml", "-o", "a.mp4", "--log-json", path},
                                       Arguments{"render", path},
                                       Arguments{"render", "c", "-o", path},
                                       Arguments{"thumbnail", path},
                                       Arguments{"thumbnail", "s.toml", "-o", path},
                                       Arguments{"sheet", path},
                                       Arguments{"sheet", "s.toml", "-o", path},
                                       Arguments{"join", path, "-o", "x.mp4"},
                                       Arguments{"join", "a.png", "-o", path},
                                       Arguments{"sweep", path, "--set", "time.fps=1,2"},
                                       Arguments{"sweep", "s.toml", "--list", path},
                                       Arguments{"sweep", "s.toml", "--set", "time.fps=1,2", "-o", path},
                                       Arguments{"farm", "status", path},
                                       Arguments{"farm", "submit", "s.toml", "-o", path, "--dry-run"},
                                       Arguments{"new", path},
                                       Arguments{"watch", path, "--times", "0"},
                                       Arguments{"diff", path, "a.png"},
                                       Arguments{"diff", "a.png", path},
                                       Arguments{"diff", "a.png", "a.png", "--limits", path},
                                       Arguments{"diff", "a.png", "a.png", "--heatmap", path},
                                       Arguments{"diff", "a.png", "a.png", "--html", path},
                                       Arguments{"accept", path, "a.png", "--reason", "why"},
                                       Arguments{"accept", "a.png", path, "--reason", "why"},
                                       Arguments{"review", path},
                                       Arguments{"review", "c", "-o", path},
                                       Arguments{"review", "c", "--reference", path},
                                       Arguments{"export", path, "-o", "x"},
                                       Arguments{"export", "c", "-o", path},
                                       Arguments{"bench", "accuracy", path},
                                       Arguments{"bench", "accuracy", "s.toml", "-o", path}})
      expect_refused(arguments);
  }
}

TEST_F(AnyInput, InARemovedFolderCausesNoInternalError) {
  const fs::path gone = folder_ / "gone";
  const std::string scene = (folder_ / "s.toml").string(), cache = (folder_ / "c").string();
  for (const Arguments& arguments :
       {Arguments{"check", "s.toml"}, Arguments{"run", "s.toml"}, Arguments{"run", scene, "-o", "a.mp4"},
        Arguments{"simulate", scene, "--cache", "c"}, Arguments{"render", cache}, Arguments{"thumbnail", scene},
        Arguments{"sheet", scene}, Arguments{"sweep", scene, "--set", "time.fps=1,2"}, Arguments{"new", "x"},
        Arguments{"diff", "a.png", "b.png"}, Arguments{"review", "."}, Arguments{"export", cache, "-o", "x"},
        Arguments{"doctor"}}) {
    fs::create_directories(gone);
    std::string command = std::string("rmdir ../gone && exec ") + WEFT_PROGRAM;
    for (const std::string& word : arguments) command += " " + word;
    const fs::path out = folder_ / "out.txt";
    command = "cd '" + gone.string() + "' && " + command + " >'" + out.string() + "' 2>&1";
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    EXPECT_EQ(code, 2) << arguments[0] << ": " << support::read_bytes(out);
  }
}

TEST_F(AnyInput, DoctorWithoutAPlaceForTemporaryFilesSaysSo) {
  ::setenv("TMPDIR", "/nowhere/at/all", 1);
  const Outcome outcome = run_weft({"doctor"}, folder_);
  ::unsetenv("TMPDIR");
  EXPECT_EQ(outcome.exit_code, 6) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "no folder for temporary files: No such file or directory; set TMPDIR to one"))
      << outcome.out;
}

// The checksum is valid, but the content is not: the test replaces eight bytes by an extreme number, at one place after
// another.
TEST_F(AnyInput, AFrameWithWildContentUnderARightChecksumIsDrawnOrNamed) {
  const std::string whole = support::read_bytes(folder_ / "c/frame_00001.weft");
  const cache::Content content = cache::unpack(whole);
  const auto try_frame = [&](const std::string& payload) {
    support::write_bytes(folder_ / "c/frame_00001.weft", cache::pack(content.label, payload));
    fs::remove(folder_ / "t.png");
    const Outcome outcome =
        run_weft({"thumbnail", "c", "--frame", "1", "-o", "t.png", "--size", "64x36", "--quality", "draft"}, folder_);
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 4) << outcome.exit_code << outcome.err;
  };
  const std::array numbers{1e308, -1e300, 0.0, 1e-310};
  for (std::size_t at = 0, k = 0; at + 8 <= std::min<std::size_t>(content.payload.size(), 240); at += 24, ++k) {
    std::string payload = content.payload;
    std::memcpy(&payload[at], &numbers[k % numbers.size()], sizeof(double));
    try_frame(payload);
  }
  support::write_bytes(folder_ / "c/frame_00001.weft", whole);
}

TEST_F(AnyInput, WithTooManyEntriesIsRefused) {
  std::string columns = "time.fps", values = "25";
  for (int i = 0; i < 20'000; ++i) columns += fmt::format(",k{}", i), values += ",1";
  write("wide.csv", columns + "\n" + values + "\n" + values + "2\n");
  expect_refused({"sweep", "s.toml", "--list", "wide.csv", "-o", "w"}, "expected at most 200 keys of a run");
  std::string manifest = support::read_bytes(folder_ / "c/manifest.json");
  const std::size_t at = manifest.find("\"frame_count\": 21");
  ASSERT_NE(at, std::string::npos);
  support::write_bytes(folder_ / "c/manifest.json", manifest.replace(at, 17, "\"frame_count\": 10000000"));
  expect_refused({"render", "c", "-o", "x.mp4"}, "frame_count: expected 1 to 100001");
  std::string runs = "{}";
  for (int i = 0; i < 10'000; ++i) runs += ", {}";
  write("w/sweep.json", R"({"options": [], "runs": [)" + runs + "]}");
  expect_refused({"farm", "status", "w"}, "expected at most 10000 runs, got 10001");
}

}  // namespace
}  // namespace weft::cli
