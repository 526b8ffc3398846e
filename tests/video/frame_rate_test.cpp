#include "film/video/frame_rate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/test_folder.hpp"

namespace weft::video {
namespace {

TEST(FrameRate, DecimalsBecomeTheFractionTheyStandFor) {
  const struct {
    double fps;
    int numerator, denominator;
  } cases[] = {{25, 25, 1},
               {12.5, 25, 2},
               {7.3, 73, 10},
               {0.1, 1, 10},
               {1000.0 / 3, 1000, 3},
               {23.976, 24000, 1001},
               {29.97, 30000, 1001},
               {59.94, 60000, 1001},
               {119.88, 120000, 1001},
               {24000.0 / 1001, 24000, 1001}};
  for (const auto& c : cases) {
    const AVRational rate = frame_rate(c.fps);
    EXPECT_EQ(rate.num, c.numerator) << c.fps;
    EXPECT_EQ(rate.den, c.denominator) << c.fps;
  }
}

TEST(FrameRate, RatesCloseToABroadcastRateStayThemselves) {
  EXPECT_EQ(av_q2d(frame_rate(23.98)), 23.98);
  EXPECT_EQ(av_q2d(frame_rate(29.969)), 29.969);
  EXPECT_EQ(av_q2d(frame_rate(24)), 24);
}

TEST(FrameRate, RatesOfNoVideoAreRefused) {
  for (const double fps :
       {0.0, -25.0, 0.001, 1001.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    for (const char* words : {"fps: expected 0.01 to 1000 frames a second in a video, got ", "the STEP of --frames"})
      support::expect_error(ExitCode::output_failed, words, [&] { frame_rate(fps); });
  }
}

}  // namespace
}  // namespace weft::video
