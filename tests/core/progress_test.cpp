#include "core/progress.hpp"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(FormatDuration, PicksTheUnitByLength) {
  EXPECT_EQ(format_duration(0), "0 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1:00 min");
  EXPECT_EQ(format_duration(187), "3:07 min");
  EXPECT_EQ(format_duration(3765), "1:02:45 h");
  EXPECT_EQ(format_duration(-1), "0 s");
}

TEST(RemainingTime, IsUnknownUntilThereIsAPace) {
  RemainingTime remaining({100, 100, 100});
  EXPECT_EQ(remaining.seconds(), std::nullopt);
  remaining.sample(0, {0, 0, 0});
  remaining.sample(5, {0, 0, 0});
  EXPECT_EQ(remaining.seconds(), std::nullopt);
}

TEST(RemainingTime, FollowsTheSlowestStage) {
  RemainingTime remaining({100, 100, 100});
  remaining.sample(0, {0, 0, 0});
  remaining.sample(10, {40, 20, 20});  // 4 per second, then 2 per second
  ASSERT_TRUE(remaining.seconds());
  EXPECT_DOUBLE_EQ(*remaining.seconds(), 40);  // 80 frames at 2 per second
}

TEST(RemainingTime, ForgetsThePaceOfLongAgo) {
  RemainingTime remaining({1000, 0, 0});
  remaining.sample(0, {0, 0, 0});
  remaining.sample(10, {500, 0, 0});                                               // a fast start: 50 per second
  for (int t = 20; t <= 60; t += 10) remaining.sample(t, {500 + (t - 10), 0, 0});  // then 1 per second
  ASSERT_TRUE(remaining.seconds());
  EXPECT_DOUBLE_EQ(*remaining.seconds(), 450);  // 450 frames left at 1 per second
}

TEST(RemainingTime, IgnoresAStageThatHasNotBegun) {
  RemainingTime remaining({100, 10, 10});  // only the last ten frames are drawn
  remaining.sample(0, {0, 0, 0});
  remaining.sample(10, {50, 0, 0});
  ASSERT_TRUE(remaining.seconds());
  EXPECT_DOUBLE_EQ(*remaining.seconds(), 10);
}

TEST(RemainingTime, IsNotThatOfStagesWithNothingLeft) {
  for (const StageCounts& totals : {StageCounts{100, 0, 0}, StageCounts{0, 100, 100}}) {
    RemainingTime remaining(totals);
    remaining.sample(0, {0, 0, 0});
    remaining.sample(5, {0, 0, 0});
    EXPECT_EQ(remaining.seconds(), std::nullopt) << "before the first frame";
  }
  RemainingTime remaining({2, 2, 2});
  remaining.sample(0, {0, 0, 0});
  for (const double t : {1.0, 20.0, 40.0}) remaining.sample(t, {2, 0, 0});
  EXPECT_EQ(remaining.seconds(), std::nullopt) << "a picture that takes longer than half a minute";
}

TEST(RemainingTime, IsZeroWhenAllIsDone) {
  RemainingTime remaining({2, 2, 2});
  remaining.sample(0, {0, 0, 0});
  remaining.sample(1, {2, 2, 2});
  EXPECT_EQ(remaining.seconds(), 0.0);
}

TEST(ProgressBar, FillsWithTheFramesOfAllStages) {
  EXPECT_EQ(progress_bar({0, 0, 0}, {4, 4, 3}, std::nullopt, 200),
            "[------------]   0 %  sim 0  drawn 0  written 0 of 3");
  EXPECT_EQ(progress_bar({3, 2, 1}, {4, 4, 4}, 12.0, 200),
            "[######------]  50 %  12 s left  sim 3  drawn 2  written 1 of 4");
  EXPECT_EQ(progress_bar({4, 4, 4}, {4, 4, 4}, 0.0, 200),
            "[############] 100 %  0 s left  sim 4  drawn 4  written 4 of 4");
}

TEST(ProgressBar, OfAThousandFramesFitsAnOldTerminal) {
  const std::string bar = progress_bar({9999, 999, 998}, {10000, 1000, 1000}, 3599, 80);
  EXPECT_NE(bar.find("written 998 of 1000"), std::string::npos) << bar;
}

TEST(ProgressBar, StaysOneColumnNarrowerThanTheTerminal) {
  EXPECT_EQ(progress_bar({1, 0, 0}, {4, 4, 4}, 3.0, 40).size(), 39u);
}

TEST(ProgressLine, NamesAllStagesAndBothTimes) {
  EXPECT_EQ(progress_line({60, 57, 55}, {126, 100, 100}, 12, 75.0),
            "60 of 126 frames simulated, 57 of 100 drawn, 55 written after 12 s, about 1:15 min left");
  EXPECT_EQ(progress_line({0, 0, 0}, {126, 126, 126}, 5, std::nullopt),
            "0 of 126 frames simulated, 0 of 126 drawn, 0 written after 5 s");
}

}  // namespace
}  // namespace weft
