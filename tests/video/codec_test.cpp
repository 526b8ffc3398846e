// Codecs for editing.
#include <gtest/gtest.h>

#include <cmath>

#include "decode.hpp"
#include "film/video/decoder.hpp"
#include "film/video/encoder.hpp"
#include "support/test_folder.hpp"

namespace weft::video {
namespace {

using support::expect_error;
using CodecTest = support::TestFolder;

/// Noise, which no lossy codec preserves.
image::Image noise(int seed) {
  image::Image image(33, 21);
  std::uint32_t state = 77 + static_cast<std::uint32_t>(seed);
  for (std::uint8_t& byte : image.rgb) {
    state = state * 1664525 + 1013904223;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return image;
}

image::Image ramp() {
  image::Image image(64, 32);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = static_cast<std::uint8_t>(4 * x);
      pixel[1] = static_cast<std::uint8_t>(8 * y);
      pixel[2] = static_cast<std::uint8_t>(255 - 4 * x);
    }
  }
  return image;
}

void write(const std::filesystem::path& file, Codec codec, const std::vector<image::Image>& pictures) {
  Settings settings;
  settings.width = pictures.front().width;
  settings.height = pictures.front().height;
  settings.fps = 30;
  settings.codec = codec;
  settings.metadata = {{"scene_hash", "0123"}};
  Encoder encoder(file, settings);
  for (const image::Image& picture : pictures) encoder.add(picture);
  encoder.finish();
}

TEST_F(CodecTest, LosslessOnesKeepEveryByte) {
  const std::vector<image::Image> pictures{noise(1), noise(2), noise(3)};
  for (const auto& [codec, name] : {std::pair{Codec::automatic, "ffv1.mkv"},
                                    {Codec::h264_lossless, "h264.mkv"},
                                    {Codec::h264_lossless, "h264.mp4"}}) {
    write((folder_ / name), codec, pictures);
    Decoder decoder((folder_ / name));
    EXPECT_EQ(decoder.metadata().at("scene_hash"), "0123") << name;
    for (const image::Image& picture : pictures) {
      const auto decoded = decoder.next();
      ASSERT_TRUE(decoded) << name;
      EXPECT_EQ(decoded->width, picture.width) << name << ": nothing is padded";
      EXPECT_EQ(decoded->rgb, picture.rgb) << name;
    }
    EXPECT_FALSE(decoder.next()) << name;
  }
}

TEST_F(CodecTest, SamePicturesGiveTheSameBytesInEveryKindOfFile) {
  const std::vector<image::Image> pictures{ramp(), ramp()};
  for (const auto& [codec, ending] : {std::pair{Codec::automatic, ".mkv"},
                                      {Codec::h264, ".mkv"},
                                      {Codec::automatic, ".mov"},
                                      {Codec::automatic, ".mp4"}}) {
    for (const char* name : {"a", "b"}) write((folder_ / name).replace_extension(ending), codec, pictures);
    EXPECT_EQ(support::read_bytes((folder_ / "a").replace_extension(ending)),
              support::read_bytes((folder_ / "b").replace_extension(ending)))
        << ending;
  }
}

// From several equal pictures, the encoder makes frames that the file stores out of their order in time.
TEST_F(CodecTest, FramesOutOfOrderAreAtTheirTimesInEveryKindOfFile) {
  for (const char* name : {"cut.mp4", "cut.mov", "cut.mkv"}) {
    write((folder_ / name), Codec::h264, std::vector(12, ramp()));
    Decoder decoder((folder_ / name));
    int count = 0;
    while (decoder.next()) ++count;
    EXPECT_EQ(count, 12) << name;
  }
}

// ProRes has 10 bits and half of the chroma columns. A ramp is decoded to within 3 levels (measured: 2).
TEST_F(CodecTest, ProResKeepsRamps) {
  write((folder_ / "cut.mov"), Codec::automatic, {ramp()});
  Decoder decoder((folder_ / "cut.mov"));
  const auto decoded = decoder.next();
  ASSERT_TRUE(decoded);
  int largest = 0;
  for (std::size_t i = 0; i < decoded->rgb.size(); ++i)
    largest = std::max(largest, std::abs(decoded->rgb[i] - ramp().rgb[i]));
  EXPECT_LE(largest, 3);
}

TEST_F(CodecTest, DecoderNamesTheCodec) {
  for (const Codec codec : {Codec::h264, Codec::h264_lossless, Codec::ffv1, Codec::prores}) {
    write(folder_ / "cut.mkv", codec, {ramp()});
    EXPECT_EQ(Decoder(folder_ / "cut.mkv").codec(), codec) << static_cast<int>(codec);
  }
}

TEST_F(CodecTest, FilesThatDoNotHoldACodecAreNamed) {
  expect_error(ExitCode::usage, "prores is kept in files ending in .mov or .mkv",
               [&] { write((folder_ / "cut.mp4"), Codec::prores, {ramp()}); });
  EXPECT_EQ(codec_of("a.mp4", Codec::automatic), Codec::h264);
  EXPECT_EQ(codec_of("a.mov", Codec::h264), Codec::h264);
  EXPECT_TRUE(is_written(".mkv"));
  EXPECT_FALSE(is_written(".webm"));
}

}  // namespace
}  // namespace weft::video
