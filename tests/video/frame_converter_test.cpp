#include "film/video/frame_converter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace weft::video {
namespace {

// Y', Cb, Cr of an 8-bit colour in limited range (ITU-R BT.709-6, items 3.2 to 3.4).
std::array<double, 3> bt709(int red, int green, int blue) {
  const double r = red / 255.0, g = green / 255.0, b = blue / 255.0;
  const double luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return {16 + 219 * luma, 128 + 224 * (b - luma) / 1.8556, 128 + 224 * (r - luma) / 1.5748};
}

void fill(image::Image& image, int red, int green, int blue) {
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = static_cast<std::uint8_t>(red);
    image.rgb[i + 1] = static_cast<std::uint8_t>(green);
    image.rgb[i + 2] = static_cast<std::uint8_t>(blue);
  }
}

int sample(const AVFrame& frame, int plane, int x, int y) {
  return frame.data[plane][y * frame.linesize[plane] + x];
}

TEST(FrameConverter, ColoursFollowTheStandardInLimitedRange) {
  FrameConverter converter(16, 16, "test");
  const FramePtr frame = converter.make_frame();
  image::Image image(16, 16);
  for (const int red : {0, 51, 128, 255}) {
    for (const int green : {0, 77, 190, 255}) {
      for (const int blue : {0, 33, 140, 255}) {
        fill(image, red, green, blue);
        converter.convert(image, *frame);
        const auto expected = bt709(red, green, blue);
        // Measured error: at most 0.506 levels; 0.5 is rounding, the rest comes from swscale's 15-bit coefficients.
        for (int plane = 0; plane < 3; ++plane) {
          EXPECT_NEAR(sample(*frame, plane, 3, 5), expected[plane], 0.52)
              << red << " " << green << " " << blue << " plane " << plane;
        }
      }
    }
  }
}

TEST(FrameConverter, ChromaLiesOnTheLeftColumnAndBetweenTwoRows) {
  // Blue increases by 8 levels per column or per row. A shift by half a pixel then changes Cb by 1.76 levels.
  FrameConverter converter(32, 32, "test");
  const FramePtr frame = converter.make_frame();
  for (const bool along_x : {true, false}) {
    image::Image image(32, 32);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) image.pixel(x, y)[2] = static_cast<std::uint8_t>(8 * (along_x ? x : y));
    }
    converter.convert(image, *frame);
    for (int i = 3; i < 13; ++i) {
      const double blue = 8 * (along_x ? 2 * i : 2 * i + 0.5);
      const double expected = 128 + 224 * (blue / 255) * (1 - 0.0722) / 1.8556;
      EXPECT_NEAR(sample(*frame, 1, along_x ? i : 8, along_x ? 8 : i), expected, 0.52) << along_x << " " << i;
    }
  }
}

TEST(FrameConverter, OddSizesRepeatTheLastColumnAndRow) {
  FrameConverter converter(15, 9, "test");
  const FramePtr frame = converter.make_frame();
  ASSERT_EQ(frame->width, 16);
  ASSERT_EQ(frame->height, 10);
  image::Image image(15, 9);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 15; ++x) image.pixel(x, y)[1] = static_cast<std::uint8_t>(10 * x + 5 * y);
  }
  converter.convert(image, *frame);
  for (int y = 0; y < 10; ++y) EXPECT_EQ(sample(*frame, 0, 15, y), sample(*frame, 0, 14, y)) << y;
  for (int x = 0; x < 16; ++x) EXPECT_EQ(sample(*frame, 0, x, 9), sample(*frame, 0, x, 8)) << x;
  EXPECT_NEAR(sample(*frame, 0, 15, 9), bt709(0, 180, 0)[0], 0.52);
}

}  // namespace
}  // namespace weft::video
