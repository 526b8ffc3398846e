// Thumbnails and sheets, from scenes and from caches.
#include <gtest/gtest.h>

#include "cli/cached_run.hpp"
#include "film/cache/names.hpp"
#include "film/image/png.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class Stills : public CachedRun {
 protected:
  image::Metadata about(const char* picture) const {
    image::Metadata metadata;
    image::read_png(folder_ / picture, &metadata);
    return metadata;
  }
  std::vector<std::uint8_t> pixels(const char* picture) const { return image::read_png(folder_ / picture).rgb; }
};

TEST_F(Stills, SheetShowsEvenlySpacedFramesFromTheFirstToTheLast) {
  expect_well({"sheet", "s.toml", "--count", "5", "--columns", "3"});
  EXPECT_EQ(about("output/s.sheet.png").at("frames"), "0 5 10 15 20");
  EXPECT_EQ(about("output/s.sheet.png").at("scene"), "s");
  const image::Image three = image::read_png(folder_ / "output/s.sheet.png");
  EXPECT_GT(three.width, 3 * 64);
  EXPECT_LT(three.width, 4 * 64);
  EXPECT_GT(three.height, 2 * 36);
  expect_well({"sheet", "s.toml", "-o", "one.png", "--count", "1"});
  EXPECT_EQ(about("one.png").at("frames"), "10");
  expect_well({"sheet", "s.toml", "-o", "few.png", "--set", "time.duration=0.08"});
  EXPECT_EQ(about("few.png").at("frames"), "0 1 2") << "a scene of three frames has no more";
}

// The scene is invalid at the start: if the command simulated it, the exit code would be 3.
TEST_F(Stills, SheetThatNoPngCanHoldIsRefusedBeforeTheSimulation) {
  const Arguments sheet{"sheet", "s.toml", "--set", "cloth.cloth.position=[0,0,0.02]", "--columns", "1", "--count"};
  const auto of = [&](const char* count) {
    Arguments arguments = sheet;
    arguments.insert(arguments.end(), {count, "--size", "16x8192"});
    return run_weft(arguments, folder_);
  };
  expect_exit(of("2"), 2, "expected a sheet of at most 16384x16384 pixels, got one of 34x");
  EXPECT_EQ(of("1").exit_code, 3);
}

TEST_F(Stills, OneCallDrawsAPictureOfEachSceneAndGoesOnAfterBrokenOnes) {
  for (const char* name : {"b.toml", "deep/c.toml"}) {
    fs::create_directories((folder_ / name).parent_path());
    fs::copy_file(folder_ / "s.toml", folder_ / name);
  }
  support::write_bytes(folder_ / "broken.toml", "[cloth]\n");
  expect_well({"simulate", "s.toml", "--cache", "cache_of_s", "--frames", ":3"});
  const Outcome outcome = weft(
      {"thumbnail", "broken.toml", "none.toml", "s.toml", "deep/c.toml", "b.toml", "--frame", "2", "-o", "stills"});
  expect_exit(outcome, 3, "broken.toml: no picture, exit code 3");
  EXPECT_TRUE(contains(outcome.err, "none.toml: no picture, exit code 3")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "3 of 5 pictures are drawn")) << outcome.err;
  expect_well({"thumbnail", "s.toml", "--frame", "2", "-o", "one.png"});
  for (const char* picture : {"stills/s.png", "stills/b.png", "stills/c.png"})
    EXPECT_EQ(pixels(picture), pixels("one.png")) << picture;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "stills"), {}), 3);
  // One scene is also possible with a folder (a shell pattern may match a single file), and a cache.
  expect_well({"thumbnail", "s.toml", "--frame", "2", "-o", "more/of"});
  EXPECT_EQ(pixels("more/of/s.png"), pixels("one.png"));
  expect_well({"thumbnail", "b.toml", "cache_of_s", "--frame", "2"});
  EXPECT_EQ(pixels("output/s.png"), pixels("output/b.png"));
  expect_well({"thumbnail", "b.toml", "s.toml", "--start", "-o", "stills"});
  EXPECT_EQ(about("stills/b.start.png").at("scene"), "b");
}

// Scenes that cannot be read are reported before the first drawing, but the exit code is that of the first scene in
// order.
TEST_F(Stills, ExitCodeIsThatOfTheFirstSceneThatFailed) {
  EXPECT_EQ(weft({"thumbnail", "s.toml", "none.toml", "--frame", "30"}).exit_code, 2);
  EXPECT_EQ(weft({"thumbnail", "none.toml", "s.toml", "--frame", "30"}).exit_code, 3);
}

TEST_F(Stills, OfSeveralScenesNoneIsDrawnWhereAPictureWouldBeLost) {
  fs::create_directories(folder_ / "deep");
  fs::copy_file(folder_ / "s.toml", folder_ / "deep/s.toml");
  fs::copy_file(folder_ / "s.toml", folder_ / "b.toml");
  const auto expect_refused = [&](std::vector<std::string> arguments, int code, const std::string& words) {
    arguments.insert(arguments.begin(), "thumbnail");
    expect_exit(weft(arguments), code, words);
  };
  expect_refused({"s.toml", "deep/s.toml", "-o", "stills", "--overwrite"}, 2, "stills/s.png is what -o writes");
  expect_refused({"s.toml", "b.toml", "-o", "one.png"}, 2,
                 "-o: expected a folder for the pictures of 2 scenes, got one.png");
  fs::create_directories(folder_ / "stills");
  support::write_bytes(folder_ / "stills/b.png", "kept");
  expect_refused({"s.toml", "b.toml", "-o", "stills"}, 6, "stills/b.png: exists already");
  EXPECT_EQ(support::read_bytes(folder_ / "stills/b.png"), "kept");
  EXPECT_FALSE(fs::exists(folder_ / "stills/s.png"));
}

TEST_F(Stills, FromACacheAreThoseFromTheScene) {
  expect_well({"simulate", "s.toml", "--cache", "c"});
  for (const char* input : {"s.toml", "c"}) {
    const std::string name = fs::path(input).stem();
    expect_well({"sheet", input, "-o", name + "_sheet.png", "--count", "4"});
    expect_well({"thumbnail", input, "-o", name + "_chosen.png"});
  }
  // The camera is computed from all frames up to the requested one.
  expect_well({"simulate", "s.toml", "--cache", "c_to_7", "--frames", ":8"});
  expect_well({"thumbnail", "s.toml", "-o", "s_7.png", "--frame", "7"});
  expect_well({"thumbnail", "c_to_7", "-o", "c_7.png", "--frame", "7"});
  EXPECT_EQ(pixels("s_sheet.png"), pixels("c_sheet.png"));
  EXPECT_EQ(pixels("s_chosen.png"), pixels("c_chosen.png"));
  EXPECT_EQ(pixels("s_7.png"), pixels("c_7.png"));
  EXPECT_NE(pixels("s_7.png"), pixels("s_chosen.png"));
  EXPECT_EQ(about("s_chosen.png"), about("c_chosen.png"));
}

TEST_F(Stills, OfAnUnfinishedCacheShowWhatIsThere) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":8"});
  fs::remove(folder_ / "c" / cache::frame_file(3));
  expect_well({"sheet", "c", "-o", "sheet.png"});
  EXPECT_EQ(about("sheet.png").at("frames"), "0 1 2 4 5 6 7");
  EXPECT_EQ(weft({"thumbnail", "c", "-o", "t.png", "--frame", "7"}).exit_code, 0);
  expect_exit(weft({"thumbnail", "c", "-o", "x.png", "--frame", "3"}), 9, "frame 3 is missing");
}

// The cloth is flat at first, wraps around the ball, and lies on it at the end.
TEST_F(Stills, ThumbnailShowsTheClothAtWorkNotFlatInTheAir) {
  expect_exit(weft({"thumbnail", "s.toml", "-o", "t.png"}), 0, "the most informative of 21");
  EXPECT_GT(std::stoi(about("t.png").at("frame")), 6) << "the cloth meets the ball at frame 6";
}

TEST_F(Stills, SceneWhoseClothIsNeverSeenIsDrawnWithAWarning) {
  expect_exit(weft({"thumbnail", "s.toml", "-o", "t.png", "--set", "cloth.cloth.position=[0,0,-3]", "--set",
                    "camera=[{name='up',position=[0,0,1],target=[0,0,5]}]"}),
              0, "no frame shows any cloth");
}

// The sheet intersects the ball, which no run accepts: `check` and `run` print the same message, and the picture shows
// the place in red.
TEST_F(Stills, OfAStartThatIsRefusedShowInRedWhatMeets) {
  const Arguments low{"--set", "cloth.cloth.position=[0,0,0.02]"};
  const auto with = [&](const Arguments& arguments) { return weft(joined(arguments, low)); };
  const Outcome refused = with({"run", "s.toml", "-o", "r.mp4"}),
                checked = run_weft({"check", "s.toml", low[0], low[1]}, folder_);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(checked.exit_code, 3);
  EXPECT_TRUE(contains(refused.err, "in 1 place: 'cloth' and 'ball' (")) << refused.err;
  EXPECT_TRUE(contains(refused.err, "'weft thumbnail --start' draws it")) << refused.err;
  EXPECT_TRUE(contains(refused.err, checked.err.substr(0, checked.err.find('\n')))) << checked.err;

  expect_exit(with({"thumbnail", "s.toml", "--start", "-o", "refused.png"}), 0, "in 1 place: 'cloth' and 'ball' (");
  expect_well({"thumbnail", "s.toml", "--start", "-o", "good.png"});
  const auto red_share = [&](const char* picture) {
    const image::Image image = image::read_png(folder_ / picture);
    std::size_t red = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        red += image.pixel(x, y)[0] == 225 && image.pixel(x, y)[1] == 20 && image.pixel(x, y)[2] == 40;
    return static_cast<double>(red) / (image.width * image.height);
  };
  EXPECT_GT(red_share("refused.png"), 0.005);
  EXPECT_EQ(red_share("good.png"), 0);
  EXPECT_EQ(weft({"thumbnail", "s.toml", "--start", "--frame", "3", "-o", "x.png"}).exit_code, 2);
}

TEST_F(Stills, WhatCannotBeIsRefusedBeforeSimulating) {
  EXPECT_EQ(weft({"sheet", "s.toml", "-o", "a.jpg"}).exit_code, 2);
  EXPECT_EQ(weft({"sheet", "s.toml", "--count", "0"}).exit_code, 2);
  EXPECT_EQ(weft({"sheet", "none.toml"}).exit_code, 3);
  EXPECT_EQ(weft({"sheet", "."}).exit_code, 4) << "a folder that is no cache";
  support::write_bytes(folder_ / "a.png", "precious");
  EXPECT_EQ(weft({"sheet", "s.toml", "-o", "a.png"}).exit_code, 6);
  EXPECT_EQ(support::read_bytes(folder_ / "a.png"), "precious");
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", ":2"});
  EXPECT_EQ(weft({"sheet", "c", "-o", "b.png", "--set", "time.fps=9"}).exit_code, 2);
}

}  // namespace
}  // namespace weft::cli
