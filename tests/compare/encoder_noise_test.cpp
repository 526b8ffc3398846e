#include <gtest/gtest.h>

#include "film/video/encoder.hpp"
#include "support/test_folder.hpp"
#include "tools/compare/files.hpp"

namespace weft::compare {
namespace {

using EncoderNoiseTest = support::TestFolder;

/// A soft gradient with noise of one or two levels: encoders change such pictures most.
image::Image gradient(std::uint32_t seed, int brighter) {
  image::Image image(320, 192);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      seed = seed * 1664525 + 1013904223;
      const int level = 120 + x / 8 + y / 16 + brighter + static_cast<int>(seed >> 31);
      for (int k = 0; k < 3; ++k) image.pixel(x, y)[k] = static_cast<std::uint8_t>(level);
    }
  }
  return image;
}

FileComparison compared(const std::filesystem::path& folder, const std::string& ending, int brighter) {
  const auto write = [&](const std::string& name, std::uint32_t seed, int more) {
    video::Settings settings;
    settings.width = 320;
    settings.height = 192;
    video::Encoder encoder(folder / name, settings);
    for (std::uint32_t k = 0; k < 4; ++k) encoder.add(gradient(seed + k, more));
    encoder.finish();
    return folder / name;
  };
  const auto reference = write("a" + ending, 1, 0), test = write("b" + ending, 77, brighter);
  return compare_files(reference, test, limits_for({}, reference, test));
}

TEST_F(EncoderNoiseTest, NoisePassesAndBrighterLightDoesNot) {
  EXPECT_TRUE(compared(folder_, ".mp4", 0).good());
  EXPECT_FALSE(compared(folder_, "_2.mp4", 12).good());
}

TEST_F(EncoderNoiseTest, LosslessVideosAreComparedAsPictures) {
  compared(folder_, ".mkv", 0);
  EXPECT_FALSE(is_lossy_video((folder_ / "a.mkv")));
  EXPECT_FALSE(is_lossy_video((folder_ / "absent.mp4")));
}

TEST(EncoderNoise, LimitsThatAreGivenStay) {
  for (const double given : {0.001, Limits::kFlip}) EXPECT_EQ(with_encoder_noise({.flip = given}).flip, given);
  EXPECT_GT(with_encoder_noise({.flip = 0.001}).spot, Limits::kSpot);
}

}  // namespace
}  // namespace weft::compare
