#include "tools/review/run_data.hpp"

#include <gtest/gtest.h>

#include "review/made_runs.hpp"

namespace weft::review {
namespace {

TEST(FrameColumns, OneArrayForEachQuantityWithNullWhereAFrameHasNone) {
  const Json frames = Json::parse(R"([{"frame": 0, "a": 1.5}, {"frame": 1, "b": true, "a": "x"}, {"frame": 2}])");
  EXPECT_EQ(frame_columns(frames),
            Json::parse(R"({"frame": [0, 1, 2], "a": [1.5, null, null], "b": [null, true, null]})"));
  EXPECT_EQ(frame_columns(Json::array()), Json::object());
}

TEST(FrameColumns, KeepSixDigits) {
  const Json frames = Json::parse(R"([{"a": 0.0123456789, "b": 123456789, "c": -1.23456789e-30, "d": 0.0}])");
  EXPECT_EQ(frame_columns(frames).dump(), R"({"a":[0.0123457],"b":[123456789],"c":[-1.23457e-30],"d":[0]})");
}

// Numbers of any size: std::stod() would throw for those below 2.2e-308.
TEST(FrameColumns, TakeNumbersOfAllSizes) {
  const Json columns = frame_columns(Json::parse(R"([{"v": 5e-324}, {"v": 1e-310}, {"v": 1.7e308}, {"v": -1e-320}])"));
  EXPECT_DOUBLE_EQ(columns.at("v")[0].get<double>(), 5e-324);
  EXPECT_DOUBLE_EQ(columns.at("v")[1].get<double>(), 1e-310);
  EXPECT_DOUBLE_EQ(columns.at("v")[2].get<double>(), 1.7e308);
}

TEST(FrameColumns, OfAnOddFileAreBounded) {
  Json frames = Json::array();
  for (int i = 0; i < 5000; ++i) frames.push_back({{fmt::format("k{}", i), 1}});
  EXPECT_EQ(frame_columns(frames).size(), 200u);
}

TEST(ColumnDigest, TellsWhatTheFiguresNeed) {
  const Json columns = Json::parse(
      R"({"frame": [5, 6, 7, 8], "a": [null, 2.5, -1, 2.5], "b": [true, false, true, true], "c": [null, null, null, null]})");
  const Json digest = column_digest(columns);
  EXPECT_EQ(digest.size(), 2u);
  EXPECT_EQ(nlohmann::json(digest.at("a")), nlohmann::json::parse(R"({"count": 3, "sum": 4.0, "min": -1, "min_frame": 7,
                                                                      "max": 2.5, "max_frame": 6, "last": 2.5})"));
  EXPECT_EQ(digest.at("frame").at("count"), 4);
}

TEST(SceneValues, HaveThePathsThatSetTakes) {
  const std::string scene =
      "up = \"z\"\n[time]\nstep = 0.01\n[[cloth]]\nname = \"band\"\nsize = [1, 0.5]\n"
      "[cloth.material]\nstretch = [4e3, 4e3]\nself = true\n[[camera]]\nfov = 40\n";
  EXPECT_EQ(nlohmann::json(scene_values(scene, "a.toml")), nlohmann::json::parse(R"({
    "up": "\"z\"", "time.step": "0.01", "cloth.band.name": "\"band\"", "cloth.band.size": "[1, 0.5]",
    "cloth.band.material.stretch": "[4000, 4000]", "cloth.band.material.self": "true", "camera.0.fov": "40"})"));
}

TEST(SceneValues, WhatIsNoTomlIsNamedWithItsLine) {
  support::expect_error(ExitCode::asset_unreadable, "a.toml:2: not readable as TOML",
                        [] { scene_values("a = 1\nb =\n", "a.toml"); });
}

class RunData : public MadeRuns {
 protected:
  Json only_run() const {
    const auto runs = find_runs(folder_);
    EXPECT_EQ(runs.size(), 1u);
    return run_data(runs.at(0));
  }

  void expect_times(const PictureTimes& expected) const {
    const PictureTimes times = picture_times(find_runs(folder_).at(0));
    EXPECT_EQ(times.first, expected.first);
    EXPECT_EQ(times.step, expected.step);
    EXPECT_EQ(times.count, expected.count);
    EXPECT_EQ(times.fps, expected.fps);
  }
};

TEST_F(RunData, PicturesOfAVideoAreTheWrittenFrames) {
  write("a.mp4");
  write("a.json", R"({"scene": "s", "output": "a.mp4", "fps": 50, "frames": [
    {"frame": 0, "written": false}, {"frame": 1, "written": true}, {"frame": 2, "written": false},
    {"frame": 3, "written": true}, {"frame": 4, "written": false}, {"frame": 5, "written": true}]})");
  expect_times({1, 2, 3, 25});
}

// In a farm, the simulation writes the statistics of all frames, and other tasks draw a part of them.
TEST_F(RunData, VideoOfAPartOfTheFramesTellsWhichItShows) {
  video::Settings settings;
  settings.width = 64;
  settings.height = 36;
  settings.metadata["frames"] = "1:6:2";
  video::Encoder encoder(folder_ / "a.mp4", settings);
  for (int frame = 1; frame < 6; frame += 2) encoder.add(picture(frame));
  encoder.finish();
  write("a.json", R"({"scene": "s", "output": "cache", "fps": 50, "frames": [
    {"frame": 0, "written": true}, {"frame": 1, "written": true}, {"frame": 2, "written": true},
    {"frame": 3, "written": true}, {"frame": 4, "written": true}, {"frame": 5, "written": true}]})");
  expect_times({1, 2, 3, 25});
}

TEST_F(RunData, NumberedPicturesTellTheirFrames) {
  write("f_008.png");
  write("f_004.png");
  write("f_012.png");
  expect_times({4, 4, 3, 0});
}

// In a farm, some tasks may not have drawn their pictures yet.
TEST_F(RunData, MissingPicturesBetweenOthersAreNamed) {
  for (const char* picture : {"f_000.png", "f_001.png", "f_004.png", "f_005.png"}) write(picture);
  EXPECT_EQ(only_run().at("problems").at(1),
            "f_004.png: expected a number 1 above that of the picture before it, got 3 above: pictures "
            "between them are missing");
  const PictureTimes times = picture_times(find_runs(folder_).at(0));
  EXPECT_EQ(times.frames, (std::vector<long long>{0, 1, 4, 5}));
  std::filesystem::remove(folder_ / "f_001.png");
  std::filesystem::remove(folder_ / "f_005.png");
  EXPECT_EQ(only_run().at("problems").dump().find("f_004.png"), std::string::npos);
  EXPECT_TRUE(picture_times(find_runs(folder_).at(0)).frames.empty()) << "every fourth frame";
}

TEST_F(RunData, WholeRunHasNoProblems) {
  write("a.mp4");
  write("a.json", statistics("a.mp4", "\"warnings\": [\"w\"],"));
  write("a.effective.toml", "[time]\nstep = 0.01\n");
  const Json data = only_run();
  EXPECT_EQ(data.at("problems"), Json::array());
  EXPECT_EQ(data.at("stats").at("warnings"), Json::parse(R"(["w"])"));
  EXPECT_FALSE(data.at("stats").contains("frames")) << "they are in the columns";
  EXPECT_EQ(data.at("columns").at("max_strain"), Json::parse("[0, 0.0123457]"));
  EXPECT_EQ(data.at("effective").at("text"), "[time]\nstep = 0.01\n");
}

TEST_F(RunData, MissingPiecesAreNamed) {
  write("a.mp4");
  EXPECT_EQ(only_run().at("problems"),
            Json::parse(R"(["no statistics: weft run --stats FILE.json writes them, for figures and plots",
                            "no effective scene: expected an .effective.toml of this name beside the video"])"));
  std::filesystem::remove(folder_ / "a.mp4");
  write("a.json", statistics("a.mp4"));
  write("a.effective.toml", "=\n");
  const Json problems = only_run().at("problems");
  ASSERT_EQ(problems.size(), 2u) << problems;
  EXPECT_EQ(problems[0], "no video or pictures beside the statistics");
  EXPECT_EQ(problems[1].get<std::string>().find("a.effective.toml:1: not readable as TOML"), 0u) << problems;
}

}  // namespace
}  // namespace weft::review
