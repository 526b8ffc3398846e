#include "film/video/encoder.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "decode.hpp"
#include "film/video/frame_rate.hpp"
#include "film/video/join.hpp"
#include "support/test_folder.hpp"

namespace weft::video {
namespace {

using support::expect_error;
using support::read_bytes;

using EncoderTest = support::TestFolder;

constexpr int kBits = 8;        // number of bits of the frame number in a numbered picture
constexpr int kPatchSide = 16;  // pixels; a macroblock, so that the codec keeps each patch apart

Settings small(double fps = 25) {
  Settings settings;
  settings.width = kBits * kPatchSide;
  settings.height = 4 * kPatchSide;
  settings.fps = fps;
  return settings;
}

// A picture that encodes a number as a row of white and black patches on a changing colour.
image::Image numbered(int number) {
  image::Image image(kBits * kPatchSide, 4 * kPatchSide);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::uint8_t* p = image.pixel(x, y);
      const bool set = (number >> (x / kPatchSide)) & 1;
      p[0] = p[1] = p[2] = set ? 255 : 0;
      if (y < 2 * kPatchSide) p[1] = static_cast<std::uint8_t>(3 * number + x);
    }
  }
  return image;
}

// Reads the number of a decoded picture, in the middle of each patch.
int number_of(const image::Image& image) {
  int number = 0;
  for (int bit = 0; bit < kBits; ++bit) {
    const std::uint8_t* p = image.pixel(bit * kPatchSide + kPatchSide / 2, 3 * kPatchSide);
    if (p[1] > 127) number |= 1 << bit;
  }
  return number;
}

void encode_numbers(const std::filesystem::path& file, const Settings& settings, int frames) {
  Encoder encoder(file, settings);
  for (int k = 0; k < frames; ++k) encoder.add(numbered(k));
  EXPECT_EQ(encoder.frames(), frames);
  encoder.finish();
}

void expect_numbers(const DecodedVideo& video, int frames) {
  ASSERT_EQ(video.frames.size(), static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) EXPECT_EQ(number_of(video.frames[k].image), k);
}

TEST_F(EncoderTest, ExactlyTheFramesThatWentInComeOutInOrder) {
  // 1: fewer than the look-ahead of the encoder; 130: three key frame intervals.
  for (const int frames : {1, 2, 130}) {
    encode_numbers(folder_ / "a.mp4", small(), frames);
    expect_numbers(decode(folder_ / "a.mp4"), frames);
  }
}

TEST_F(EncoderTest, FrameKIsShownAtExactlyKOverFps) {
  for (const double fps : {25.0, 30.0, 12.5, 23.976, 29.97, 59.94, 7.3, 0.1}) {
    encode_numbers(folder_ / "a.mp4", small(fps), 40);
    const DecodedVideo video = decode(folder_ / "a.mp4");
    ASSERT_EQ(video.frames.size(), 40u);
    const AVRational rate = frame_rate(fps);
    for (int k = 0; k < 40; ++k) {
      const AVRational expected = av_mul_q({k, 1}, av_inv_q(rate));
      const AVRational time = video.frames[k].time;
      EXPECT_EQ(av_cmp_q(time, expected), 0) << fps << " fps, frame " << k << ": " << time.num << "/" << time.den;
    }
  }
}

TEST_F(EncoderTest, BrowsersGetYuv420pWithBt709Colours) {
  encode_numbers(folder_ / "a.mp4", small(), 3);
  const DecodedVideo video = decode(folder_ / "a.mp4");
  EXPECT_EQ(video.width, 128);
  EXPECT_EQ(video.height, 64);
  EXPECT_EQ(video.pixel_format, AV_PIX_FMT_YUV420P);
  for (const DecodedFrame& frame : video.frames) {
    EXPECT_EQ(frame.range, AVCOL_RANGE_MPEG);
    EXPECT_EQ(frame.matrix, AVCOL_SPC_BT709);
    EXPECT_EQ(frame.primaries, AVCOL_PRI_BT709);
    EXPECT_EQ(frame.transfer, AVCOL_TRC_BT709);
  }
}

// Peak signal to noise ratio [dB] of two pictures of the same size.
double psnr(const image::Image& a, const image::Image& b) {
  double sum_sq = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum_sq += std::pow(double{1} * a.rgb[i] - b.rgb[i], 2);
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.rgb.size()) / sum_sq);
}

TEST_F(EncoderTest, DecodedColoursAreThoseOfThePicture) {
  Settings settings = small();
  settings.width = 320;
  settings.height = 180;
  std::vector<image::Image> images;
  Encoder encoder(folder_ / "a.mp4", settings);
  for (int k = 0; k < 12; ++k) {
    image::Image image(320, 180);
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 320; ++x) {
        std::uint8_t* p = image.pixel(x, y);
        p[0] = static_cast<std::uint8_t>(127 + 120 * std::sin(0.03 * x + 0.2 * k));
        p[1] = static_cast<std::uint8_t>(127 + 100 * std::sin(0.05 * y));
        p[2] = static_cast<std::uint8_t>(40 + x / 2);
      }
    }
    encoder.add(image);
    images.push_back(std::move(image));
  }
  encoder.finish();
  const DecodedVideo video = decode(folder_ / "a.mp4");
  ASSERT_EQ(video.frames.size(), images.size());
  // Lowest measured: 41.0 dB. The BT.601 matrix gives 28.1 dB, full instead of limited range 27.7 dB.
  for (std::size_t k = 0; k < images.size(); ++k) EXPECT_GT(psnr(video.frames[k].image, images[k]), 37) << k;
}

TEST_F(EncoderTest, CustomMetadataComesBack) {
  Settings settings = small();
  settings.metadata = {{"title", "Band"}, {"weft_scene_hash", "8f31"}, {"weft_scene", "scenes/Tücher 布.toml"}};
  encode_numbers(folder_ / "a.mp4", settings, 2);
  const DecodedVideo video = decode(folder_ / "a.mp4");
  for (const auto& [key, value] : settings.metadata) {
    ASSERT_TRUE(video.metadata.contains(key)) << key;
    EXPECT_EQ(video.metadata.at(key), value);
  }
  EXPECT_FALSE(video.metadata.contains("creation_time"));
}

TEST_F(EncoderTest, OddSizesGrowByOne) {
  Settings settings = small();
  settings.width = 63;
  settings.height = 47;
  {
    Encoder encoder(folder_ / "odd.mp4", settings);
    image::Image image(63, 47);
    for (int y = 0; y < 47; ++y) image.pixel(62, y)[0] = image.pixel(61, y)[0] = 255;
    for (int k = 0; k < 3; ++k) encoder.add(image);
    encoder.finish();
  }
  const DecodedVideo video = decode(folder_ / "odd.mp4");
  EXPECT_EQ(video.width, 64);
  EXPECT_EQ(video.height, 48);
  ASSERT_EQ(video.frames.size(), 3u);
  // The added column repeats the red column at the edge; 20 levels are far below the 255 of a black or stale column.
  EXPECT_NEAR(video.frames[1].image.pixel(63, 20)[0], video.frames[1].image.pixel(62, 20)[0], 20);
  EXPECT_GT(video.frames[1].image.pixel(63, 47)[0], 200);
}

TEST_F(EncoderTest, OnePixelIsAVideoToo) {
  Settings settings = small();
  settings.width = settings.height = 1;
  Encoder encoder(folder_ / "dot.mp4", settings);
  encoder.add(image::Image(1, 1));
  encoder.finish();
  const DecodedVideo video = decode(folder_ / "dot.mp4");
  EXPECT_EQ(video.width, 2);
  EXPECT_EQ(video.frames.size(), 1u);
}

TEST_F(EncoderTest, TheIndexStandsBeforeTheFrames) {
  encode_numbers(folder_ / "a.mp4", small(), 60);
  const std::vector<std::string> expected = {"ftyp", "moov", "free", "mdat"};
  EXPECT_EQ(mp4_boxes(folder_ / "a.mp4"), expected);
}

TEST_F(EncoderTest, SameFramesSameBytes) {
  Settings settings = small();
  settings.threads = 2;
  encode_numbers(folder_ / "a.mp4", settings, 60);
  encode_numbers(folder_ / "b.mp4", settings, 60);
  EXPECT_EQ(read_bytes(folder_ / "a.mp4"), read_bytes(folder_ / "b.mp4"));
}

// The encoder turns off the macroblock tree of x264, which reads uninitialised memory at sizes such as these.
TEST_F(EncoderTest, WhatWasInMemoryBeforeHasNoInfluence) {
  for (const auto& [width, height] : {std::pair{64, 36}, {160, 90}, {400, 226}, {720, 404}}) {
    Settings settings;
    settings.width = width;
    settings.height = height;
    std::set<std::string> videos;
    for (const int filling : {0, 85, 170, 255}) {
      mallopt(M_PERTURB, filling);  // malloc() fills its memory with the complement
      Encoder encoder(folder_ / "a.mp4", settings);
      image::Image image(width, height);
      for (int frame = 0; frame < 12; ++frame) {
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < 3 * width; ++x) {
            const bool inside = std::hypot(x / 3 - width / 4 - 3 * frame, y - height / 2) < height / 4;
            image.pixel(0, y)[x] = static_cast<std::uint8_t>(inside ? 37 * x + 91 * y : 90 + y / 4);
          }
        encoder.add(image);
      }
      encoder.finish();
      videos.insert(read_bytes(folder_ / "a.mp4"));
    }
    mallopt(M_PERTURB, 0);
    EXPECT_EQ(videos.size(), 1U) << width << " x " << height;
  }
}

TEST_F(EncoderTest, TheFinalNameAppearsOnlyWhenFinished) {
  const std::vector<std::string> finished = {"a.mp4"};
  Encoder encoder(folder_ / "a.mp4", small());
  for (int k = 0; k < 60; ++k) encoder.add(numbered(k));
  EXPECT_EQ(files().size(), 1u);
  EXPECT_NE(files(), finished);
  encoder.finish();
  EXPECT_EQ(files(), finished);
}

TEST_F(EncoderTest, WhatIsOnDiskBeforeTheEndCanBePlayed) {
  // The test copies the temporary file as a killed process would leave it.
  Encoder encoder(folder_ / "a.mp4", small());
  for (int k = 0; k < 100; ++k) encoder.add(numbered(k));
  ASSERT_EQ(files().size(), 1u);
  std::filesystem::copy_file(folder_ / files()[0], folder_ / "killed.mp4");
  const DecodedVideo video = decode(folder_ / "killed.mp4");
  // Frames are missing at the end, because the preset of x264 holds back 10 to look ahead, and 3 to reorder them.
  ASSERT_GE(video.frames.size(), 85u);
  for (std::size_t k = 0; k < video.frames.size(); ++k) {
    EXPECT_EQ(number_of(video.frames[k].image), static_cast<int>(k));
  }
}

TEST_F(EncoderTest, WithoutFinishNothingStays) {
  {
    Encoder encoder(folder_ / "a.mp4", small());
    for (int k = 0; k < 30; ++k) encoder.add(numbered(k));
    EXPECT_EQ(files().size(), 1u);
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(EncoderTest, AnOldVideoStaysUntilTheNewOneIsWhole) {
  encode_numbers(folder_ / "a.mp4", small(), 5);
  const std::string old_bytes = read_bytes(folder_ / "a.mp4");
  {
    Encoder encoder(folder_ / "a.mp4", small());
    encoder.add(numbered(7));
  }
  EXPECT_EQ(read_bytes(folder_ / "a.mp4"), old_bytes);
  encode_numbers(folder_ / "a.mp4", small(), 6);
  expect_numbers(decode(folder_ / "a.mp4"), 6);
}

TEST_F(EncoderTest, NamesMayLookLikeProtocolsAndPatterns) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  encode_numbers("http:a %03d", small(), 4);
  expect_numbers(decode("http:a %03d"), 4);
  const std::vector<std::filesystem::path> parts{"http:a %03d", "http:a %03d"};
  join_videos(parts, "http:b", 25, 8, {});
  EXPECT_EQ(decode("http:b").frames.size(), 8U);
  std::filesystem::current_path(before);
}

TEST_F(EncoderTest, PlacesThatCannotBeWrittenAreNamedAtTheStart) {
  support::write_bytes(folder_ / "file", "");
  expect_error(ExitCode::output_failed, "Not a directory", [&] { Encoder(folder_ / "file" / "a.mp4", small()); });
  expect_error(ExitCode::output_failed, "expected the name of a file to write, got a folder or a device",
               [&] { Encoder(folder_, small()); });
  // The proc file system does not allow new files, not even for root.
  expect_error(ExitCode::output_failed,
               "/proc/self/fd/a.mp4: cannot be written: ", [&] { Encoder("/proc/self/fd/a.mp4", small()); });
}

TEST_F(EncoderTest, SettingsOutOfRangeAreNamed) {
  const auto refuse = [&](const char* words, auto change) {
    Settings settings = small();
    change(settings);
    expect_error(ExitCode::output_failed, words, [&] { Encoder(folder_ / "a.mp4", settings); });
  };
  refuse("width: expected 1 to 16384 pixels, got 0", [](Settings& s) { s.width = 0; });
  refuse("height: expected 1 to 16384 pixels, got 20000", [](Settings& s) { s.height = 20000; });
  refuse("crf: expected 1 to 51, got 0", [](Settings& s) { s.crf = 0; });
  refuse("encoder threads: expected 1 to 128, got 0", [](Settings& s) { s.threads = 0; });
  refuse("fps: expected 0.01 to 1000 frames a second in a video, got 0", [](Settings& s) { s.fps = 0; });
  refuse("preset: expected one of ultrafast, superfast,", [](Settings& s) { s.preset = "fastest"; });
  EXPECT_TRUE(files().empty());
}

TEST_F(EncoderTest, FramesOfAnotherSizeAreAnInternalError) {
  Encoder encoder(folder_ / "a.mp4", small());
  expect_error(ExitCode::internal, "frame 0: expected 128x64 pixels, got 64x64",
               [&] { encoder.add(image::Image(64, 64)); });
}

TEST_F(EncoderTest, AVideoWithoutFramesIsRefused) {
  Encoder encoder(folder_ / "a.mp4", small());
  expect_error(ExitCode::output_failed, "expected one frame or more, got none", [&] { encoder.finish(); });
}

// While an object of this class exists, files of this process cannot grow beyond `bytes`; this simulates a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(EncoderTest, AFullDiskIsReportedInTheSystemsWords) {
  const auto encode = [&] { encode_numbers(folder_ / "a.mp4", small(), 120); };
  encode();
  const auto size = std::filesystem::file_size(folder_ / "a.mp4");
  std::filesystem::remove(folder_ / "a.mp4");
  for (const auto limit : {size / 20, size / 4, size / 2, size - 1}) {
    const FileSizeLimit full(limit);
    expect_error(ExitCode::output_failed, "a.mp4: cannot ", encode);
    expect_error(ExitCode::output_failed, "File too large", encode);
    EXPECT_TRUE(files().empty()) << limit;
  }
}

TEST_F(EncoderTest, FramesAreKeptIfTheFinishedFileCannotBeMade) {
  Encoder encoder(folder_ / "a.mp4", small());
  for (int k = 0; k < 20; ++k) encoder.add(numbered(k));
  std::filesystem::create_directory(folder_ / "a.mp4");
  expect_error(ExitCode::output_failed, "all 20 frames are kept in " + (folder_ / "a.partial.mp4").string(),
               [&] { encoder.finish(); });
  expect_numbers(decode(folder_ / "a.partial.mp4"), 20);
}

TEST(EncoderDescription, NamesTheLibraryAndItsVersion) {
  EXPECT_TRUE(encoder_description().starts_with("libx264 through libavcodec 5")) << encoder_description();
}

}  // namespace
}  // namespace weft::video
