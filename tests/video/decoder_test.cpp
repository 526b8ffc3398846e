#include "film/video/decoder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "film/video/encoder.hpp"
#include "support/test_folder.hpp"
#include "video/decode.hpp"

namespace weft::video {
namespace {

class DecoderTest : public support::TestFolder {
 protected:
  // Writes a video whose colours change slowly, so that the interpolation of the chroma planes has little effect.
  void write(const char* name, int frames, int width = 96, int height = 64) const {
    Settings settings;
    settings.width = width;
    settings.height = height;
    settings.fps = 30;
    settings.metadata["gl"] = "none";
    Encoder encoder(folder_ / name, settings);
    for (int frame = 0; frame < frames; ++frame) {
      image::Image image(width, height);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          image.pixel(x, y)[0] = static_cast<std::uint8_t>(2 * x + frame);
          image.pixel(x, y)[1] = static_cast<std::uint8_t>(60 + 2 * y);
          image.pixel(x, y)[2] = static_cast<std::uint8_t>(100 + 5 * frame);
        }
      }
      encoder.add(image);
    }
    encoder.finish();
  }
};

// Expected: the formula of BT.709 with the nearest chroma sample (decode.hpp), without interpolation. Tolerance 5
// levels: half a pixel with a slope of 2 levels per pixel, weighted by up to 1.9, plus rounding.
TEST_F(DecoderTest, PicturesAreThoseOfTheFormulaInOrder) {
  write("a.mp4", 7);
  const DecodedVideo expected = decode(folder_ / "a.mp4");
  Decoder decoder(folder_ / "a.mp4");
  EXPECT_EQ(decoder.width(), 96);
  EXPECT_EQ(decoder.height(), 64);
  EXPECT_NEAR(decoder.fps(), 30, 1e-9);
  EXPECT_EQ(decoder.metadata().at("gl"), "none");
  for (std::size_t frame = 0; frame < 7; ++frame) {
    const auto image = decoder.next();
    ASSERT_TRUE(image);
    const auto& other = expected.frames[frame].image.rgb;
    ASSERT_EQ(image->rgb.size(), other.size());
    for (std::size_t i = 0; i < other.size(); ++i) ASSERT_LE(std::abs(image->rgb[i] - other[i]), 5) << frame;
  }
  EXPECT_FALSE(decoder.next());
  EXPECT_FALSE(decoder.next());
}

TEST_F(DecoderTest, WhatIsNoVideoIsAnErrorWithItsName) {
  support::write_bytes(folder_ / "a.mp4", "words");
  support::expect_error(ExitCode::asset_unreadable, "a.mp4: cannot be read as a video: Invalid data",
                        [&] { Decoder{folder_ / "a.mp4"}; });
  support::expect_error(ExitCode::asset_unreadable, "No such file", [&] { Decoder{folder_ / "b.mp4"}; });
}

}  // namespace
}  // namespace weft::video
