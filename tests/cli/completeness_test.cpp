// The program does not take incomplete results for output: missing and broken frames, pictures that are drawn later,
// parts of videos.
#include <gtest/gtest.h>
#include <signal.h>

#include <sstream>

#include "cli/cached_run.hpp"
#include "cli/video_probe.hpp"
#include "film/image/png.hpp"
#include "tools/cli/frame_range.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPicturesInP = "p/{frame:05}.png";

TEST(FramesText, TellsFramesInARowAsARange) {
  EXPECT_EQ(frames_text({7}), "7");
  EXPECT_EQ(frames_text({0, 1}), "0:2");
  EXPECT_EQ(frames_text({3, 5, 8, 9, 10}), "3, 5, 8:11");
}

class Completeness : public CachedRun {
 protected:
  void expect_not_whole(const Arguments& arguments, const std::string& message) const {
    expect_exit(weft(arguments), 9, message);
  }
  /// Cuts a file of the cache in half.
  void break_file(const std::string& name) const {
    const std::string bytes = support::read_bytes(folder_ / name);
    support::write_bytes(folder_ / name, bytes.substr(0, bytes.size() / 2));
  }
};

TEST_F(Completeness, RenderOfAPartTakesTheFramesBeforeItsEndIfTold) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  expect_not_whole({"render", "c", "-o", "all.mp4"}, "c: of frames 0:21 frames 8:21 are missing; weft simulate");
  expect_not_whole({"render", "c", "-o", "all.mp4", "--frames", "5:12:2"},
                   "c: of frames 5:12:2 frames 9, 11 are missing");
  expect_not_whole({"render", "c", "-o", "all.mp4", "--frames", "8:12", "--partial"}, "frames 8:12 are missing");
  expect_not_whole({"thumbnail", "c", "-o", "t.png", "--frame", "8"}, "frame 8 is missing");
  EXPECT_FALSE(fs::exists(folder_ / "all.mp4"));
  const Outcome part = weft({"render", "c", "-o", "part.mp4", "--partial"});
  expect_exit(part, 0, "frames 8:21 are missing; only 0:8 are used");
  EXPECT_EQ(probe_video(folder_ / "part.mp4").frames, 8);
  EXPECT_EQ(probe_video(folder_ / "part.mp4").metadata.at("frames"), "0:8");
}

TEST_F(Completeness, WhatIsNoRangeOrNoCacheIsToldApart) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  EXPECT_EQ(weft({"render", "c", "-o", "d.mp4", "--frames", "5:22"}).exit_code, 2);
  EXPECT_EQ(weft({"render", "c", "-o", "d.mp4", "--frames", ":8", "--camera", "front"}).exit_code, 2);
  EXPECT_EQ(weft({"thumbnail", "c", "-o", "t.png", "--frame", "21"}).exit_code, 2);
  expect_exit(weft({"render", "s.toml", "-o", "d.mp4"}), 4,
              "s.toml: expected a frame cache, a folder with a manifest.json");
}

TEST_F(Completeness, FramesThatAreMissingInTheMiddleOrBrokenAreNamedBeforeAnythingIsDrawn) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  fs::remove(folder_ / "c/frame_00004.weft");
  break_file("c/frame_00007.weft");
  break_file("c/frame_00012.weft");
  const std::string message =
      "c: of frames 0:21 frame 4 is missing; frames 7, 12 cannot be used: c/frame_00007.weft: broken";
  expect_not_whole({"render", "c", "-o", kPicturesInP, "--meshes", "m", "--stats", "s.json"}, message);
  for (const char* output : {"p", "m", "s.json"}) EXPECT_FALSE(fs::exists(folder_ / output)) << output;
}

// The scene has no camera, so the program computes one from all frames of the cache.
TEST_F(Completeness, BrokenFrameDoesNotKeepTheFramesBeforeItFromBeingUsed) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  break_file("c/frame_00005.weft");
  const Outcome part = weft({"render", "c", "-o", "part.mp4", "--partial"});
  expect_exit(part, 0, "only 0:5 are used");
  EXPECT_TRUE(contains(part.err, "the camera is computed without this frame")) << part.err;
  EXPECT_EQ(probe_video(folder_ / "part.mp4").frames, 5);
  expect_exit(run_weft({"export", "c", "--format", "gltf", "-o", "g", "--partial"}, folder_), 0);
}

TEST_F(Completeness, FrameBeforeAPartIsCheckedIfTheMotionNeedsIt) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":6"});
  break_file("c/frame_00002.weft");
  const Arguments blurred{"render", "c", "-o", kPicturesInP, "--motion-blur", "180", "--frames"};
  const auto of = [&](const char* frames) {
    Arguments arguments = blurred;
    arguments.emplace_back(frames);
    return arguments;
  };
  expect_not_whole(of("3:5"), "frame 3 needs the frame before it, but frame 2 cannot be used: c/frame_00002.weft");
  fs::remove(folder_ / "c/frame_00002.weft");
  expect_not_whole(of("3:5"), "frame 3 needs the frame before it, but frame 2 is missing");
  expect_not_whole({"render", "c", "-o", "p/{frame}.exr", "--frames", "4:5:2"}, "but frame 2 is missing");
  EXPECT_FALSE(fs::exists(folder_ / "p"));
  expect_well(of("3:5:2"));
  expect_well({"render", "c", "-o", "sharp/{frame}.png", "--frames", "3:5"});
}

TEST_F(Completeness, RenderResumesToThePicturesAndMeshesOfOneThatWasNotStopped) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"render", "c", "-o", "whole/{frame:05}.png", "--meshes", "mw"});
  expect_well({"render", "c", "-o", kPicturesInP, "--meshes", "m", "--frames", "3:9"});
  expect_well({"render", "c", "-o", kPicturesInP, "--meshes", "m", "--frames", "12:15"});
  fs::remove(folder_ / "m/ball_00013.ply");
  const auto drawn = fs::last_write_time(folder_ / "p/00003.png");
  const Arguments again{"render", "c", "-o", kPicturesInP, "--meshes", "m", "--resume"};
  expect_exit(weft(again), 0, "{frame:05}.png is there in part: frames 3:9, 12, 14\n");
  expect_same("whole", "p", ".png", kFrames);
  expect_same("mw", "m", ".ply", 3 * kFrames);
  EXPECT_EQ(fs::last_write_time(folder_ / "p/00003.png"), drawn) << "a picture that was there was drawn again";
  const Outcome nothing_left = weft(again);
  EXPECT_EQ(nothing_left.exit_code, 0);
  EXPECT_EQ(nothing_left.err, "note: p/{frame:05}.png is complete already: frames 0:21\n");
}

TEST_F(Completeness, RenderResumesBesideTheReportsAndTheKeptFramesOfACommandBefore) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  Arguments pictures{"render", "c", "-o", kPicturesInP, "--stats", "s.json", "--log-json", "s.log", "--frames", ":1"};
  expect_well(pictures);
  pictures.back() = ":2";
  pictures.emplace_back("--resume");
  expect_well(pictures);
  EXPECT_TRUE(contains(support::read_bytes(folder_ / "s.json"), "\"frame\": 1,"));
  fs::remove(folder_ / "p/00001.png");
  support::write_bytes(folder_ / "s.json", "{\"of\": \"others\"}\n");
  EXPECT_EQ(weft(pictures).exit_code, 6);
  const Arguments video{"render", "c", "-o", "a.mp4", "--frames", ":2", "--resume"};
  expect_well(video);
  fs::rename(folder_ / "a.mp4", folder_ / "a.partial.mp4");  // as if the disk was full at the end
  expect_well(video);
  EXPECT_FALSE(fs::exists(folder_ / "a.partial.mp4"));
}

TEST_F(Completeness, ResumeDoesNotTakeAVideoInAnotherCodecForTheFilm) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":2"});
  Arguments render{"render", "c", "-o", "a.mkv", "--frames", ":2", "--resume"};
  expect_well(render);
  render.insert(render.end(), {"--codec", "prores"});
  expect_exit(weft(render), 6, "a.mkv: exists already");
  render.back() = "ffv1";  // the default of this extension
  expect_exit(weft(render), 0, "note: a.mkv is complete already: frames 0:2\n");
}

TEST_F(Completeness, ResumeOfACompleteOutputSaysWhichReportsAreMissing) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  const Arguments run{"run", "s.toml", "-o", "a.mp4", "--resume"}, render{"render", "c", "-o", "b.mp4", "--resume"};
  for (const Arguments& command : {run, render}) {
    expect_well(command);
    Arguments with = command;
    with.insert(with.end(), {"--stats", "a.json"});
    expect_exit(weft(with), 0, "note: a.json is not written, since nothing is made again");
    EXPECT_FALSE(fs::exists(folder_ / "a.json"));
  }
  expect_well({"run", "s.toml", "-o", "c.mp4", "--stats", "c.json"});
  EXPECT_EQ(weft({"run", "s.toml", "-o", "c.mp4", "--stats", "c.json", "--resume"}).err,
            "note: c.mp4 is complete already: frames 0:21\n");
}

TEST_F(Completeness, LayersAreThoseOfOneRunAfterAResumeAndInParts) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"render", "c", "-o", "whole/{frame:05}.exr", "--frames", ":9"});
  expect_well({"render", "c", "-o", "p/{frame:05}.exr", "--frames", "3:5"});
  const auto drawn = fs::last_write_time(folder_ / "p/00003.exr");
  expect_well({"render", "c", "-o", "p/{frame:05}.exr", "--frames", ":9", "--resume"});
  EXPECT_EQ(fs::last_write_time(folder_ / "p/00003.exr"), drawn);
  expect_same("whole", "p", ".exr", 9);  // motion is relative to the previous frame, whichever command drew that frame
  support::write_bytes(folder_ / "p/00004.exr", support::read_bytes(folder_ / "p/00004.exr").substr(0, 2000));
  EXPECT_EQ(weft({"render", "c", "-o", "p/{frame:05}.exr", "--frames", ":9", "--resume"}).exit_code, 6);
}

TEST_F(Completeness, RenderDoesNotGoOnWithOtherPictures) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  const Arguments render{"render", "c", "-o", kPicturesInP, "--frames", ":4", "--resume"};
  expect_well(render);
  const std::string third = support::read_bytes(folder_ / "p/00002.png");
  // A picture of another frame under this name is not overwritten, since it may be the only copy.
  fs::copy_file(folder_ / "p/00003.png", folder_ / "p/00002.png", fs::copy_options::overwrite_existing);
  expect_exit(weft(render), 6, "p/00002.png: exists already");
  Arguments forced = render;
  forced.push_back("--overwrite");
  expect_well(forced);
  EXPECT_EQ(support::read_bytes(folder_ / "p/00002.png"), third);
}

TEST_F(Completeness, RenderDoesNotGoOnWithPicturesDrawnWithAnOptionThatIsNotGivenNow) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":2"});
  for (const Arguments& option : {Arguments{"--look", "clay"}, {"--motion-blur", "90"}, {"--depth", "16"}}) {
    const Arguments without{"render", "c", "-o", option[0] + "/{frame:05}.png", "--frames", ":2", "--resume"};
    const Arguments with = joined(without, option);
    expect_well(with);
    const Outcome again = weft(with), refused = weft(without);
    expect_exit(again, 0, "is complete already: frames 0:2");
    EXPECT_EQ(refused.exit_code, 6) << option[0];
    EXPECT_TRUE(contains(refused.err, option[0] + "/00000.png: exists already")) << refused.err;
  }
}

TEST_F(Completeness, RenderDoesNotTakeASharpThumbnailForAPictureWithMotionBlur) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--set", "render.motion_blur=180"});
  expect_well({"thumbnail", "c", "--frame", "1", "-o", "p/00001.png"});
  expect_exit(weft({"render", "c", "-o", kPicturesInP, "--frames", ":2", "--resume"}), 6,
              "p/00001.png: exists already");
}

// The camera is computed: for the thumbnail from frames 0 and 1, for the film from all frames.
TEST_F(Completeness, RenderDoesNotTakeAThumbnailWithAnotherCameraForAPictureOfTheFilm) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"thumbnail", "s.toml", "--frame", "1", "-o", "p/00001.png"});
  const Arguments render{"render", "c", "-o", kPicturesInP, "--frames", ":2", "--resume"};
  EXPECT_EQ(weft(render).exit_code, 6);
  expect_well({"thumbnail", "c", "--frame", "1", "-o", "p/00001.png", "--overwrite"});
  expect_well(render);
}

// A computed camera of a cache that lacks frames is another one than that of the film.
TEST_F(Completeness, PicturesWithTheCameraOfSomeFramesDoNotBecomeAFilmWithOthers) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  const Arguments part{"render", "c", "-o", kPicturesInP, "--frames", ":2", "--resume"};
  expect_exit(weft(part), 0, "warning: c: the camera is computed from frames 0:8 of 0:21");
  expect_well(part);
  expect_well({"thumbnail", "c", "--frame", "2", "-o", "t/00002.png"});
  expect_well({"simulate", "s.toml", "--cache", "c", "--resume"});
  expect_exit(weft(part), 6, "p/00000.png: exists already");
  EXPECT_EQ(weft({"render", "c", "-o", "t/{frame:05}.png", "--frames", "2:3", "--resume"}).exit_code, 6);
  expect_well({"render", "c", "-o", kPicturesInP, "--frames", "2:4"});
  expect_exit(run_weft({"join", "p", "-o", "a.mp4", "--frames", ":4"}, folder_), 2,
              "its camera_frames is '', that of p/00000.png is '0:8'");
}

// The picture of the start shows the scene before untangling and preroll, frame 0 the scene after them.
TEST_F(Completeness, RenderDoesNotTakeAPictureOfTheStartForFrame0) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  expect_well({"thumbnail", "s.toml", "--start", "-o", "p/00000.png"});
  expect_exit(weft({"render", "c", "-o", kPicturesInP, "--frames", ":1", "--resume"}), 6,
              "p/00000.png: exists already");
}

TEST_F(Completeness, VideoThatWasStoppedIsDrawnAnewAndAnotherIsKept) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  Subprocess process({"render", "c", "-o", "a.mp4", "--size", "640x360", "--progress", "none", "--log-json", "-"},
                     folder_);
  ASSERT_TRUE(process.wait_for_output("\"frame\":1,"));
  process.send(SIGINT);
  if (process.wait().exit_code == 0) GTEST_SKIP() << "it was done before the signal came";
  EXPECT_LT(probe_video(folder_ / "a.mp4").frames, kFrames);
  const auto render = [&](const Arguments& more) {
    return run_weft(joined({"render", "c", "-o", "a.mp4", "--size", "640x360", "--progress", "none"}, more), folder_);
  };
  EXPECT_EQ(render({"--resume", "--quality", "draft"}).exit_code, 6) << "another film has this name";
  EXPECT_EQ(render({"--resume"}).exit_code, 0);
  EXPECT_EQ(probe_video(folder_ / "a.mp4").frames, kFrames);
  EXPECT_EQ(render({"--resume"}).err, "note: a.mp4 is complete already: frames 0:21\n");
}

// The camera is computed, so that the run draws after the last frame is simulated.
TEST_F(Completeness, InterruptedDrawingNamesTheLastFrameThatIsDrawn) {
  Subprocess process({"run", "s.toml", "-o", "a.mp4", "--size", "640x360", "--progress", "none", "--log-json", "-"},
                     folder_);
  ASSERT_TRUE(process.wait_for_output("\"frame\":1,"));
  process.send(SIGINT);
  const Outcome outcome = process.wait();
  if (outcome.exit_code == 0) GTEST_SKIP() << "it was done before the signal came";
  const int drawn = probe_video(folder_ / "a.mp4").frames;
  EXPECT_TRUE(contains(outcome.err, fmt::format("interrupted after frame {} of 20; {} frames are", drawn - 1, drawn)))
      << outcome.err;
}

class Joining : public Completeness {
 protected:
  void SetUp() override {
    Completeness::SetUp();
    expect_well({"simulate", "s.toml", "--cache", "c"});
  }
  void draw(const std::string& output, const std::string& frames) const {
    expect_well({"render", "c", "-o", output, "--frames", frames, "--overwrite"});
  }
  Outcome join(const Arguments& arguments) const { return run_weft(joined({"join"}, arguments), folder_); }
  void expect_joined(const Arguments& arguments) const { expect_exit(join(arguments), 0); }
  void expect_refused(const Arguments& arguments, int code, const std::string& message) const {
    expect_exit(join(arguments), code, message);
    EXPECT_FALSE(fs::exists(folder_ / "joined.mp4"));
  }
};

TEST_F(Joining, OfFoldersIsByteForByteTheVideoOfRender) {
  draw("whole.mp4", ":");
  draw("b/{frame:05}.png", "9:21");
  draw("a/{frame}.png", ":9");
  expect_joined({"b", "a", "-o", "joined.mp4"});
  EXPECT_TRUE(support::read_bytes(folder_ / "joined.mp4") == support::read_bytes(folder_ / "whole.mp4"));
  draw("every_third.mp4", "::3");
  expect_joined({"a", "b", "-o", "third.mp4", "--frames", "::3"});
  EXPECT_TRUE(support::read_bytes(folder_ / "third.mp4") == support::read_bytes(folder_ / "every_third.mp4"));
  draw("a/film.mkv", ":3");
  expect_joined({"a", "b", "-o", "beside_a_video.mp4"});
}

TEST_F(Joining, OfPicturesWhoseMetadataNoSceneCanHaveIsRefused) {
  draw("p/{frame:05}.png", ":1");
  image::Metadata metadata;
  const image::Image picture = image::read_png(folder_ / "p/00000.png", &metadata);
  for (const auto& [key, value] : {std::pair{"scene_frames", "100002"}, {"scene_frames", "0"}, {"fps", "0"}}) {
    image::Metadata changed = metadata;
    changed[key] = value;
    image::write_png(folder_ / "p/00000.png", picture, changed);
    expect_refused({"p", "-o", "joined.mp4"}, 2, fmt::format("its {} is '{}'", key, value));
  }
}

TEST_F(Joining, OfPicturesIsInTheCodecThatIsAskedFor) {
  draw("p/{frame:05}.png", ":3");
  for (const auto& [name, options] : {std::pair{"v.mov", Arguments{}}, {"v.mkv", {}}, {"v.mp4", {"--crf", "40"}}}) {
    Arguments render{"render", "c", "-o", name}, encode{"encode", "p", "-o", std::string("e_") + name};
    for (Arguments* words : {&render, &encode}) {
      words->insert(words->end(), {"--frames", ":3"});
      words->insert(words->end(), options.begin(), options.end());
    }
    expect_well(render);
    expect_exit(run_weft(encode, folder_), 0);
    EXPECT_EQ(decoded(std::string("e_") + name), decoded(name)) << name;
  }
}

TEST_F(Joining, OfVideosKeepsEveryPictureAndItsTime) {
  std::string pictures;
  const auto lines = [&](const std::string& video) {
    // Takes only the column of hashes from lines "0, pts, duration, size, hash", since times differ between a part and
    // the whole.
    std::string hashes;
    std::istringstream text(decoded(video));
    for (std::string line; std::getline(text, line);) hashes += line.substr(line.rfind(',')) + "\n";
    return hashes;
  };
  for (const auto& [name, frames] : {std::pair{"x.mp4", ":1"}, {"y.mp4", "1:14"}, {"z.mp4", "14:21"}}) {
    draw(name, frames);
    pictures += lines(name);
  }
  expect_joined({"z.mp4", "x.mp4", "y.mp4", "-o", "joined.mp4"});
  EXPECT_EQ(lines("joined.mp4"), pictures);
  const VideoFacts facts = probe_video(folder_ / "joined.mp4");
  EXPECT_EQ(facts.frames, kFrames);
  EXPECT_NEAR(facts.duration, kFrames / 25.0, 1e-9);
  EXPECT_EQ(facts.metadata.at("frames"), "0:21");
  // The program accepts the joined video as complete.
  EXPECT_EQ(weft({"render", "c", "-o", "joined.mp4", "--resume"}).err,
            "note: joined.mp4 is complete already: frames 0:21\n");
}

TEST_F(Joining, NamesWhatIsMissingAndMakesNoFile) {
  draw("p/{frame:05}.png", ":");
  draw("a.mp4", ":9");
  draw("b.mp4", "11:21");
  for (const char* name : {"p/00004.png", "p/00010.png", "p/00011.png"}) fs::remove(folder_ / name);
  expect_refused({"p", "-o", "joined.mp4"}, 9, "of frames 0:21 frames 4, 10:12 are missing; --partial uses");
  expect_refused({"a.mp4", "b.mp4", "-o", "joined.mp4"}, 9, "of frames 0:21 frames 9:11 are missing");
  break_file("p/00007.png");
  expect_refused({"p", "-o", "joined.mp4", "--frames", "5:10"}, 9, "frame 7 is missing; p/00007.png");
  expect_joined({"p", "-o", "part.mp4", "--partial"});
  EXPECT_EQ(probe_video(folder_ / "part.mp4").frames, 4);
  expect_joined({"a.mp4", "b.mp4", "-o", "first.mp4", "--partial"});
  EXPECT_EQ(probe_video(folder_ / "first.mp4").frames, 9);
}

TEST_F(Joining, RefusesWhatIsNoPartOfTheFilm) {
  draw("p/{frame:05}.png", ":9");
  draw("a.mp4", ":9");
  draw("b.mp4", "7:21");
  expect_refused({"a.mp4", "b.mp4", "-o", "joined.mp4"}, 2, "frame 7 is in both a.mp4 and b.mp4");
  expect_refused({"p", "b.mp4", "-o", "joined.mp4"}, 2, "either videos or folders of pictures");
  expect_refused({"b.mp4", "-o", "joined.mp4", "--frames", "9:21"}, 2, "a video can only be joined whole");
  expect_well({"simulate", "s.toml", "--cache", "d", "--set", "cloth.cloth.look.color=[1,0,0]"});
  expect_well({"render", "d", "-o", "q/{frame:05}.png", "--frames", "9:21"});
  expect_refused({"p", "q", "-o", "joined.mp4"}, 2, "q/00009.png: expected parts of one video; its scene_hash is '");
  expect_refused({"c", "-o", "joined.mp4"}, 4, "c: holds no pictures");
  expect_refused({"p", "-o", "p.avi"}, 2, "-o: expected a name ending in .mp4, .mov or .mkv");
  expect_refused({"p", "-o", "p.mov", "--codec", "ffv1"}, 2, "--codec: ffv1 is kept in files ending in .mkv");
  expect_refused({"p", "-o", "p.mov", "--crf", "20"}, 2, "--crf: expected --codec h264");
  expect_refused({"b.mp4", "-o", "b.mov"}, 2, "b.mov: videos are joined as they are, into .mp4");
  expect_refused({"b.mp4", "-o", "joined.mp4", "--crf", "20"}, 2, "videos are joined as they are");
}

}  // namespace
}  // namespace weft::cli
