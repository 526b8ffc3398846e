#include "tools/cli/frame_range.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

std::vector<int> frames_of(const char* text, int frame_count) {
  const FrameRange range = resolve_frames(parse_frames(text), frame_count);
  std::vector<int> frames;
  for (int frame = 0; frame < frame_count + 5; ++frame) {
    if (range.contains(frame)) frames.push_back(frame);
  }
  EXPECT_EQ(static_cast<int>(frames.size()), range.count()) << text;
  EXPECT_EQ(frames.back(), range.last()) << text;
  return frames;
}

TEST(FrameRange, IsHalfOpenFromZero) {
  EXPECT_EQ(frames_of("0:3", 10), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(frames_of("7:10", 10), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(frames_of("4:5", 10), (std::vector<int>{4}));
}

TEST(FrameRange, EndsLeftOutAreThoseOfTheScene) {
  EXPECT_EQ(frames_of("8:", 10), (std::vector<int>{8, 9}));
  EXPECT_EQ(frames_of(":2", 10), (std::vector<int>{0, 1}));
  EXPECT_EQ(frames_of(":", 3), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(frames_of("::2", 4), (std::vector<int>{0, 2}));
}

TEST(FrameRange, StepCountsFromItsBeginning) {
  EXPECT_EQ(frames_of("1:10:3", 10), (std::vector<int>{1, 4, 7}));
  EXPECT_EQ(frames_of("1:8:3", 10), (std::vector<int>{1, 4, 7}));
  EXPECT_EQ(frames_of("1:7:3", 10), (std::vector<int>{1, 4}));
  EXPECT_EQ(frames_of("2:9:100", 10), (std::vector<int>{2}));
  EXPECT_EQ(frames_of("2:9:1000000000", 10), (std::vector<int>{2}));
}

TEST(FrameRange, RefusesWhatIsNotARange) {
  for (const char* text : {"", "5", "a:b", "-1:4", "0:4:0", "0:4:-1", "0:4:2147483647", "0:1:2:3", "1.5:3", "4:4",
                           "5:2", ":0", "0:99999999999", "0 :4"}) {
    EXPECT_THROW(parse_frames(text), Error) << text;
  }
}

TEST(FrameRange, RefusesFramesThatTheSceneDoesNotHaveNamingThoseItHas) {
  support::expect_error(ExitCode::usage, "--frames: expected a range within 0:126, the frames of this scene, got 0:127",
                        [] { resolve_frames(parse_frames("0:127"), 126); });
  EXPECT_THROW(resolve_frames(parse_frames("126:"), 126), Error);
  EXPECT_NO_THROW(resolve_frames(parse_frames("125:"), 126));
}

}  // namespace
}  // namespace weft::cli
