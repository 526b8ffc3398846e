#include <gtest/gtest.h>

#include <algorithm>

#include "review/made_runs.hpp"

namespace weft::review {
namespace {

class FindRuns : public MadeRuns {};

TEST_F(FindRuns, FilesOfOneNameAreOneRun) {
  write("band.mp4");
  write("band.json", statistics("elsewhere/band.mp4"));
  write("band.effective.toml");
  write("ball.mp4");
  EXPECT_EQ(found(), "ball: ball.mp4\nband: band.mp4 band.json band.effective.toml\n");
}

TEST_F(FindRuns, StatisticsNameTheirVideo) {
  write("a.mp4");
  write("b.mp4");
  write("statistics.json", statistics("out/b.mp4"));
  EXPECT_EQ(found(), "a: a.mp4\nstatistics: b.mp4 statistics.json\n");
}

TEST_F(FindRuns, VideoIsFoundBesideMovedStatistics) {
  write("moved/stats.json", statistics("elsewhere/out/b.mp4"));
  write("moved/out/b.mp4");
  write("b.mp4");
  EXPECT_EQ(found(), "b: b.mp4\nmoved/stats: b.mp4 stats.json\n");
}

// With `weft review .`, files are listed as "./b.mp4".
TEST_F(FindRuns, StatisticsNameTheirVideoAndPicturesAlsoInAFolderGivenWithADot) {
  write("in/b.mp4");
  write("in/statistics.json", statistics("b.mp4"));
  write("in/p/0.png");
  write("in/p/1.png");
  write("in/pictures.json", statistics("in/p/{frame}.png"));
  const std::string runs = "pictures: pictures.json 0.png 1.png\nstatistics: b.mp4 statistics.json\n";
  EXPECT_EQ(found("in"), runs);
  for (const char* folder : {"./in", "in/.", "in/", "in/../in"}) EXPECT_EQ(found(folder), runs) << folder;
}

TEST_F(FindRuns, EffectiveSceneOfTheVideoIsPreferredToThatOfTheScene) {
  write("a.mp4");
  write("a.json", statistics("a.mp4"));
  write("s.effective.toml");
  EXPECT_EQ(found(), "a: a.mp4 a.json s.effective.toml\n");
  write("a.effective.toml");
  EXPECT_EQ(found(), "a: a.mp4 a.json a.effective.toml\n");
}

TEST_F(FindRuns, NumberedPicturesAreARunInTheOrderOfTheirNumbers) {
  write("p/f_10.png");
  write("p/f_9.png");
  write("p/thumbnail.png");
  write("p/single_1.png");
  EXPECT_EQ(found(), "p/f: f_9.png f_10.png\n");
  write("p.json", statistics("p/f_{frame}.png"));
  EXPECT_EQ(found(), "p: p.json f_9.png f_10.png\n");
}

TEST_F(FindRuns, PicturesNamedByNumbersAloneAreNamedAsTheirFolder) {
  write("p/0.png");
  write("p/1.png");
  EXPECT_EQ(found(), "p: 0.png 1.png\n");
  for (const char* folder : {"p", "p/", "p/."}) EXPECT_EQ(found(folder), "p: 0.png 1.png\n") << folder;
}

// Decisions are stored by key: those on the pictures would count for the video.
TEST_F(FindRuns, OfOneNameHaveKeysOfTheirOwn) {
  for (const char* file : {"band.mp4", "film.mp4", "band/0.png", "band/1.png", "band_0.png", "band_1.png"}) write(file);
  write("band.json", statistics("film.mp4"));
  std::vector<std::string> keys;
  for (const RunFiles& run : find_runs(folder_)) {
    EXPECT_EQ(run.name, "band");
    keys.push_back(run.key);
  }
  std::ranges::sort(keys);
  EXPECT_EQ(keys, (std::vector<std::string>{"band", "band (pictures)", "band (pictures) 2", "band (video)"}));
}

TEST_F(FindRuns, OfASweepAreInItsOrderAndHaveItsValues) {
  write("w/sweep.json", R"({"runs": [{"folder": "bend=10", "set": {"a.bend": "10"}},
                                     {"folder": "bend=2", "set": {"a.bend": "2"}}, {"folder": "bend=2"}, 1]})");
  for (const char* run : {"w/bend=2/s", "w/bend=10/s", "w/other", "a", "z"}) write(std::string(run) + ".mp4");
  EXPECT_EQ(found(), "a: a.mp4\nw/bend=10/s: s.mp4\nw/bend=2/s: s.mp4\nw/other: other.mp4\nz: z.mp4\n");
  const auto runs = find_runs(folder_ / "w");
  EXPECT_EQ(runs[0].values, (Json{{"a.bend", "10"}}));
  EXPECT_EQ(runs[1].values, (Json{{"a.bend", "2"}}));
  EXPECT_TRUE(runs[2].values.is_null());
}

TEST_F(FindRuns, PicturesOfWhichAFarmHasJoinedTheVideoAreNoRunOfTheirOwn) {
  write("w/sweep.json", R"({"runs": [{"folder": "b=1", "set": {}}, {"folder": "b=2", "set": {}}]})");
  for (const char* picture :
       {"w/b=1/frames/00000.png", "w/b=1/frames/00001.png", "w/b=2/frames/00000.png", "w/b=2/frames/00001.png"})
    write(picture);
  write("w/b=1/s.mp4");
  EXPECT_EQ(found(), "w/b=1/s: s.mp4\nw/b=2/frames: 00000.png 00001.png\n");
}

TEST_F(FindRuns, HiddenFilesAndFormerPagesArePassedOver) {
  write(".band.mp4.1.tmp.mp4");
  write(".git/band.mp4");
  write("page/index.html", fmt::format("<meta {} 1\">", kPageMark));
  write("page/runs/band/video.mp4");
  write("site/index.html", "<title>Something else</title>");
  write("site/video.mp4");
  EXPECT_EQ(found(), "site/video: video.mp4\n");
}

TEST_F(FindRuns, OtherJsonIsNoRunButIsNamedWhereAVideoMissesIt) {
  write("package.json", "{}");
  write("log.json", "{\"event\": 1}\n{\"event\": 2}\n");
  write("a.json", "{\"scene\": ");
  write("a.mp4");
  write("b.json", "{\"scene\": \"s\", \"frames\": [1]}");
  write("b.mp4");
  const auto runs = find_runs(folder_);
  ASSERT_EQ(runs.size(), 2u);
  ASSERT_EQ(runs[0].problems.size(), 1u);
  EXPECT_NE(runs[0].problems[0].find("a.json: not readable as JSON"), std::string::npos) << runs[0].problems[0];
  ASSERT_EQ(runs[1].problems.size(), 1u);
  EXPECT_EQ(runs[1].problems[0], "b.json: expected the statistics that weft run --stats writes");
}

TEST_F(FindRuns, VideosThatNoBrowserPlaysAreNamed) {
  write("a.mov");
  write("a.json", statistics("runs/a.mov"));
  const auto runs = find_runs(folder_);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_TRUE(runs[0].video.empty());
  ASSERT_EQ(runs[0].problems.size(), 1u);
  EXPECT_EQ(runs[0].problems[0],
            "a.mov: browsers play H.264 in .mp4 only; weft run -o NAME.mp4 or weft render writes it");
}

TEST_F(FindRuns, WhatIsNoFolderIsRefused) {
  write("a.mp4");
  support::expect_error(ExitCode::asset_unreadable, "expected a folder", [&] { find_runs(folder_ / "a.mp4"); });
  support::expect_error(ExitCode::asset_unreadable, "expected a folder", [&] { find_runs(folder_ / "b"); });
}

}  // namespace
}  // namespace weft::review
