#include "tools/cli/output_target.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

TEST(FramePattern, PutsTheFrameNumberInItsPlace) {
  EXPECT_EQ(FramePattern("out/{frame:05}.png").name(42), "out/00042.png");
  EXPECT_EQ(FramePattern("out/{frame:5}.png").name(42), "out/00042.png");
  EXPECT_EQ(FramePattern("a{frame}b.png").name(42), "a42b.png");
  EXPECT_EQ(FramePattern("{frame:02}.png").name(12345), "12345.png");
  EXPECT_EQ(FramePattern("take {1}/{frame:03}_{a}.png").name(7), "take {1}/007_{a}.png") << "other braces are names";
}

TEST(FramePattern, RefusesNamesThatAllFramesWouldShareOrThatMeanSomethingElse) {
  for (const char* text : {"still.png", "{frame", "frame}", "}{", "{frame}{frame}.png", "{scene}.png", "{frame:x}.png",
                           "{frame:0}.png", "{frame:-3}.png", "{frame:99}.png", "{}.png"}) {
    EXPECT_THROW(FramePattern{text}, Error) << text;
  }
}

class FramesOnDisk : public support::TestFolder {};

const auto kAny = [](const std::filesystem::path&, int) { return true; };

TEST_F(FramesOnDisk, OfALongerRunAreRemovedByTheirExactNamesOnly) {
  std::filesystem::create_directories(folder_ / "a_00009.png");
  const std::vector<std::string> stays{"a_00002.png",  "a_00004.png", "a_3.png",     "a_000003.png", "a_-0003.png",
                                       "a_00003x.png", "a_00003.jpg", "b_00003.png", "a_.png",       "xa_00003.png"};
  const std::vector<std::string> goes{"a_00000.png", "a_00003.png", "a_00005.png", "a_123456.png"};
  for (const auto& names : {stays, goes})
    for (const std::string& name : names) support::write_bytes(folder_ / name, "x");
  FramePattern((folder_ / "a_{frame:05}.png").string()).remove_others({2, 5, 2}, kAny);
  for (const std::string& name : stays) EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  for (const std::string& name : goes) EXPECT_FALSE(std::filesystem::exists(folder_ / name)) << name;
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "a_00009.png"));
}

TEST_F(FramesOnDisk, OfSomebodyElseStay) {
  for (const char* name : {"a_00001.png", "a_00003.png"}) support::write_bytes(folder_ / name, "x");
  FramePattern((folder_ / "a_{frame:05}.png").string()).remove_others({0, 1, 1}, [](const auto& file, int frame) {
    EXPECT_EQ(file.filename(), fmt::format("a_{:05}.png", frame));
    return frame == 3;
  });
  EXPECT_EQ(files(), std::vector<std::string>{"a_00001.png"});
}

TEST_F(FramesOnDisk, InFoldersOfTheirOwnAreFoundToo) {
  for (const char* name : {"00001/a.png", "00002/a.png", "00002/b.png", "x/a.png"}) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    support::write_bytes(folder_ / name, "x");
  }
  FramePattern((folder_ / "{frame:05}/a.png").string()).remove_others({0, 2, 1}, kAny);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "00001/a.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "00002/a.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "00002/b.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "x/a.png"));
}

TEST(OutputTarget, IsChosenByTheEnding) {
  EXPECT_EQ(parse_output("", "band").file(3), "output/band.mp4");
  EXPECT_EQ(parse_output("x/y.mp4", "band").kind, OutputTarget::Kind::video);
  EXPECT_EQ(parse_output("take {1}/y.mp4", "band").file(3), "take {1}/y.mp4");
  EXPECT_EQ(parse_output("x/{frame}.png", "band").kind, OutputTarget::Kind::images);
  EXPECT_EQ(parse_output("x/{frame}.png", "band").file(7), "x/7.png");
  for (const char* text : {"x.avi", "x", "x.png", "{frame}.mp4", ".mp4x"}) {
    EXPECT_THROW(parse_output(text, "band"), Error) << text;
  }
}

}  // namespace
}  // namespace weft::cli
