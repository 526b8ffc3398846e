#include "tools/compare/files.hpp"

#include <gtest/gtest.h>

#include "compare/pictures.hpp"
#include "film/image/png.hpp"
#include "film/video/encoder.hpp"
#include "support/test_folder.hpp"

namespace weft::compare {
namespace {

using Outcome = FileComparison::Outcome;

class Files : public support::TestFolder {
 protected:
  void write(const char* name, const image::Image& image) const { image::write_png(folder_ / name, image); }

  void write_video(const char* name, const std::vector<image::Image>& images) const {
    video::Settings settings;
    settings.width = images.front().width;
    settings.height = images.front().height;
    video::Encoder encoder(folder_ / name, settings);
    for (const image::Image& image : images) encoder.add(image);
    encoder.finish();
  }

  FileComparison compare(const char* reference, const char* test) const {
    return compare_files(folder_ / reference, folder_ / test, {});
  }
};

TEST_F(Files, PicturesAreReadAndCompared) {
  const image::Image picture = textured(64, 48, 1);
  write("a.png", picture);
  write("b.png", with_noise(picture, 4, 1, 3));
  write("c.png", with_noise(picture, 300, 50, 3));
  EXPECT_EQ(compare("a.png", "a.png").outcome, Outcome::same);
  EXPECT_EQ(compare("a.png", "b.png").outcome, Outcome::within);
  const FileComparison result = compare("a.png", "c.png");
  EXPECT_EQ(result.outcome, Outcome::differs);
  EXPECT_EQ(result.frames, 1);
  EXPECT_EQ(result.frames_differing, 1);
  EXPECT_GT(result.worst.figures.largest, 40);
}

TEST_F(Files, OtherSizeIsItsOwnOutcomeAndNothingIsCompared) {
  write("a.png", plain(64, 48, 1, 2, 3));
  write("b.png", plain(48, 64, 1, 2, 3));
  const FileComparison result = compare("a.png", "b.png");
  EXPECT_EQ(result.outcome, Outcome::size);
  EXPECT_EQ(result.problem, "48x64 pixels, the reference has 64x48");
  EXPECT_EQ(result.frames, 0);
}

TEST_F(Files, UnreadablePictureIsNamed) {
  write("a.png", plain(64, 48, 1, 2, 3));
  support::write_bytes(folder_ / "b.png", support::read_bytes(folder_ / "a.png").substr(0, 60));
  const FileComparison result = compare("a.png", "b.png");
  EXPECT_EQ(result.outcome, Outcome::unreadable);
  EXPECT_NE(result.problem.find("b.png: cannot be read as PNG"), std::string::npos) << result.problem;
}

// Twelve frames of moving waves; frame `changed` shows an additional square.
std::vector<image::Image> film(int changed = -1) {
  std::vector<image::Image> images;
  for (int frame = 0; frame < 12; ++frame) {
    image::Image image(96, 64);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        const bool square = frame == changed && x > 30 && x < 50 && y > 20 && y < 40;
        const double value = square ? 250 : 120 + 60 * std::sin(0.1 * x + 0.15 * y + 0.2 * frame);
        std::fill_n(image.pixel(x, y), 3, static_cast<std::uint8_t>(value));
      }
    }
    images.push_back(image);
  }
  return images;
}

TEST_F(Files, VideosAreComparedFrameByFrameAndTheWorstIsNamed) {
  write_video("a.mp4", film());
  write_video("b.mp4", film(7));
  EXPECT_EQ(compare("a.mp4", "a.mp4").outcome, Outcome::same);
  const FileComparison result = compare("a.mp4", "b.mp4");
  EXPECT_EQ(result.outcome, Outcome::differs);
  EXPECT_TRUE(result.video);
  EXPECT_EQ(result.frames, 12);
  EXPECT_EQ(result.worst_frame, 7);
  EXPECT_GT(result.worst.figures.largest, 60);
  // The encoder also changes frames near frame 7. They count as spill, not as different.
  const FileComparison lenient = compare_files(folder_ / "a.mp4", folder_ / "b.mp4", with_encoder_noise({}));
  EXPECT_EQ(lenient.first_differing, 7);
  EXPECT_EQ(lenient.frames_differing, 1);
  EXPECT_EQ(lenient.outcome, Outcome::differs);
}

TEST_F(Files, FramesThatDifferByThemselvesAreNotTakenForSpill) {
  std::vector<image::Image> two = film(7);
  two[3] = film(3)[3];
  write_video("a.mp4", film());
  write_video("b.mp4", two);
  const FileComparison result = compare_files(folder_ / "a.mp4", folder_ / "b.mp4", with_encoder_noise({}));
  EXPECT_EQ(result.first_differing, 3);
  EXPECT_EQ(result.frames_differing, 2);
}

TEST_F(Files, ShorterVideoSaysBothLengthsAndComparesWhatIsThere) {
  std::vector<image::Image> short_film = film();
  short_film.resize(9);
  write_video("a.mp4", film());
  write_video("b.mp4", short_film);
  EXPECT_EQ(compare("a.mp4", "b.mp4").outcome, Outcome::frame_count);
  EXPECT_EQ(compare("a.mp4", "b.mp4").problem, "9 frames, the reference has 12");
  EXPECT_EQ(compare("b.mp4", "a.mp4").problem, "12 frames, the reference has 9");
  EXPECT_EQ(compare("b.mp4", "a.mp4").frames, 9);
}

TEST_F(Files, VideosOfOtherSizeAreNotCompared) {
  write_video("a.mp4", {plain(64, 48, 9, 9, 9)});
  write_video("b.mp4", {plain(96, 48, 9, 9, 9)});
  EXPECT_EQ(compare("a.mp4", "b.mp4").outcome, Outcome::size);
}

TEST_F(Files, BrokenVideoIsUnreadable) {
  write_video("a.mp4", film());
  const std::string bytes = support::read_bytes(folder_ / "a.mp4");
  support::write_bytes(folder_ / "b.mp4", bytes.substr(0, 300));
  support::write_bytes(folder_ / "c.mp4", "not a video");
  EXPECT_EQ(compare("a.mp4", "b.mp4").outcome, Outcome::unreadable);
  EXPECT_EQ(compare("a.mp4", "c.mp4").outcome, Outcome::unreadable);
}

TEST_F(Files, VideoAgainstPictureIsUnreadable) {
  write("a.png", plain(64, 48, 1, 2, 3));
  write_video("b.mp4", {plain(64, 48, 1, 2, 3)});
  EXPECT_EQ(compare("a.png", "b.mp4").outcome, Outcome::unreadable);
}

}  // namespace
}  // namespace weft::compare
