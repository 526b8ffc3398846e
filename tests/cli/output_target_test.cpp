#include "cli/output_target.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"

namespace weft::cli {
namespace {

TEST(FramePattern, PutsTheFrameNumberInItsPlace) {
  EXPECT_EQ(FramePattern("out/{frame:05}.png").name(42), "out/00042.png");
  EXPECT_EQ(FramePattern("out/{frame:5}.png").name(42), "out/00042.png");
  EXPECT_EQ(FramePattern("a{frame}b.png").name(42), "a42b.png");
  EXPECT_EQ(FramePattern("{frame:02}.png").name(12345), "12345.png");
}

TEST(FramePattern, RefusesNamesThatAllFramesWouldShareOrThatMeanSomethingElse) {
  for (const char* text : {"still.png", "{frame", "frame}", "}{", "{frame}{frame}.png", "{scene}.png", "{frame:x}.png",
                           "{frame:0}.png", "{frame:-3}.png", "{frame:99}.png", "{}.png"}) {
    EXPECT_THROW(FramePattern{text}, Error) << text;
  }
}

TEST(OutputTarget, IsChosenByTheEnding) {
  EXPECT_EQ(parse_output("", "band").file(3), "output/band.mp4");
  EXPECT_EQ(parse_output("x/y.mp4", "band").kind, OutputTarget::Kind::video);
  EXPECT_EQ(parse_output("x/{frame}.png", "band").kind, OutputTarget::Kind::images);
  EXPECT_EQ(parse_output("x/{frame}.png", "band").file(7), "x/7.png");
  for (const char* text : {"x.avi", "x", "x.png", "{frame}.mp4", ".mp4x"}) {
    EXPECT_THROW(parse_output(text, "band"), Error) << text;
  }
}

}  // namespace
}  // namespace weft::cli
