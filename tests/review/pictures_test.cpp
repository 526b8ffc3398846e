#include "tools/review/pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "film/image/png.hpp"
#include "review/made_runs.hpp"

namespace weft::review {
namespace {

class Pictures : public MadeRuns {
 protected:
  RunFiles stills(const std::string& name, int count, int gray = 200) {
    RunFiles run;
    for (int i = 0; i < count; ++i) {
      run.pictures.push_back(folder_ / fmt::format("{}_{:03}.png", name, i));
      image::write_png(run.pictures.back(), picture(i, gray));
    }
    return run;
  }

  static std::vector<long long> numbers(const PictureSummary& found) {
    std::vector<long long> all;
    for (const Tile& tile : found.tiles) all.push_back(tile.picture);
    return all;
  }
};

TEST_F(Pictures, TilesAreEvenlySpacedAndFromEightToFifteenOfMany) {
  const RunFiles all = stills("s", 70);
  for (int count = 1; count <= 70; ++count) {
    RunFiles first = all;
    first.pictures.resize(static_cast<std::size_t>(count));
    const std::vector<long long> tiles = numbers(read_pictures(first));
    const std::size_t most = std::min<std::size_t>(static_cast<std::size_t>(count), 15);
    EXPECT_LE(tiles.size(), most);
    EXPECT_GE(tiles.size(), std::min<std::size_t>(most, 8)) << count;
    EXPECT_EQ(tiles.front(), 0);
    const long long stride = tiles.size() > 1 ? tiles[1] : 1;
    for (std::size_t i = 0; i < tiles.size(); ++i) EXPECT_EQ(tiles[i], static_cast<long long>(i) * stride);
    EXPECT_GE(tiles.back() + stride, count) << "none is missing at the end";
  }
}

TEST_F(Pictures, OfAVideoAreThoseThatWereEncoded) {
  write_video("a.mp4", 20);
  RunFiles run;
  run.video = folder_ / "a.mp4";
  const PictureSummary found = read_pictures(run);
  EXPECT_EQ(found.count, 20);
  EXPECT_EQ(found.fps, 50);
  EXPECT_EQ(found.width, 64);
  EXPECT_EQ(numbers(found), (std::vector<long long>{0, 2, 4, 6, 8, 10, 12, 14, 16, 18}));
  for (const Tile& tile : found.tiles) {
    // The left edge of the square is at twice the picture number: bright inside, dark before it.
    const int edge = 2 * static_cast<int>(tile.picture);
    EXPECT_GT(tile.image.pixel(std::min(edge + 2, 63), 18)[1], 150) << tile.picture;
    if (edge > 4) {
      EXPECT_LT(tile.image.pixel(edge - 3, 18)[1], 50) << tile.picture;
    }
  }
}

TEST_F(Pictures, BrokenFilesAreErrors) {
  RunFiles run = stills("s", 3);
  support::write_bytes(run.pictures[2], "no picture");
  support::expect_error(ExitCode::asset_unreadable, "s_002.png", [&] { read_pictures(run); });
  RunFiles video;
  video.video = folder_ / "a.mp4";
  write("a.mp4", "no video");
  support::expect_error(ExitCode::asset_unreadable, "a.mp4", [&] { read_pictures(video); });
}

TEST(SameMoment, IsTheNearestPictureOfTheOther) {
  const PictureTimes every{0, 1, 100, 50}, third{6, 3, 30, 50.0 / 3}, slow{0, 1, 100, 25};
  EXPECT_EQ(index_at_same_time(7, every, every), 7);
  EXPECT_EQ(index_at_same_time(0, third, every), 6) << "the first of the sparse ones shows frame 6";
  EXPECT_EQ(index_at_same_time(4, third, every), 18);
  EXPECT_EQ(index_at_same_time(18, every, third), 4);
  EXPECT_EQ(index_at_same_time(0, every, third), -2) << "before the other begins";
  EXPECT_EQ(index_at_same_time(8, every, slow), 4);
  EXPECT_EQ(index_at_same_time(5, every, {0, 1, 100, 0}), 5) << "without a rate, by number";
}

TEST_F(Pictures, AreComparedMomentByMoment) {
  const RunFiles run = stills("a", 10);
  RunFiles sparse = stills("b", 10);
  for (int i = 9; i > 0; i -= 2) sparse.pictures.erase(sparse.pictures.begin() + i);
  const PictureTimes times{0, 1, 10, 50}, sparse_times{0, 2, 5, 25};
  const auto pairs = compare_with_reference(run, times, sparse, sparse_times, {0, 2, 4, 6, 8});
  ASSERT_EQ(pairs.size(), 5u);
  for (const PairComparison& pair : pairs) {
    EXPECT_EQ(pair.reference, pair.picture / 2);
    EXPECT_EQ(pair.verdict, compare::Verdict::same) << pair.picture;
  }
  const auto later = compare_with_reference(run, times, sparse, {0, 1, 5, 50}, {0, 2, 4, 6, 8});
  ASSERT_EQ(later.size(), 3u) << "the reference ends";
  EXPECT_EQ(later[0].verdict, compare::Verdict::same);
  EXPECT_EQ(later[1].verdict, compare::Verdict::differs) << "frame 2 against frame 4";
}

// Frames 2 and 3 of the run and frame 5 of the reference are missing.
TEST_F(Pictures, AreComparedWithThoseOfTheSameNumberIfSomeAreMissing) {
  RunFiles run = stills("a", 8), reference = stills("b", 8);
  run.pictures.erase(run.pictures.begin() + 2, run.pictures.begin() + 4);
  reference.pictures.erase(reference.pictures.begin() + 5);
  const auto pairs = compare_with_reference(run, picture_times(run), reference, picture_times(reference), {0, 2, 3, 4});
  ASSERT_EQ(pairs.size(), 3u) << "frames 0, 4 and 6";
  for (const PairComparison& pair : pairs) EXPECT_EQ(pair.verdict, compare::Verdict::same) << pair.picture;
  EXPECT_EQ(pairs[1].reference, 4);
  EXPECT_EQ(pairs[2].reference, 5);
}

TEST_F(Pictures, VideoAndStillsCanBeCompared) {
  write_video("a.mp4", 6);
  RunFiles video;
  video.video = folder_ / "a.mp4";
  const PictureTimes times{0, 1, 6, 50};
  const auto pairs = compare_with_reference(video, times, stills("s", 6), times, {0, 3, 5});
  ASSERT_EQ(pairs.size(), 3u);
  for (const PairComparison& pair : pairs) EXPECT_GT(pair.figures.ssim, 0.9) << pair.picture;
}

// Two levels on a fifth of the picture: more than the limits of stills, less than the change by an encoder.
TEST_F(Pictures, OfLossyVideosHaveTheLimitsOfDiff) {
  const auto film = [&](const std::string& name, std::uint8_t above) {
    image::Image image(320, 180);
    std::fill(std::fill_n(image.rgb.begin(), image.rgb.size() / 5, above), image.rgb.end(), std::uint8_t{150});
    video::Settings settings;
    settings.width = image.width;
    settings.height = image.height;
    video::Encoder encoder(folder_ / name, settings);
    encoder.add(image);
    encoder.finish();
    RunFiles run;
    run.video = folder_ / name;
    return run;
  };
  const PictureTimes times{0, 1, 1, 25};
  for (const auto& [ending, verdict] :
       {std::pair(".mp4", compare::Verdict::within), std::pair(".mkv", compare::Verdict::differs)}) {
    const auto pairs = compare_with_reference(film(std::string("a") + ending, 152), times,
                                              film(std::string("b") + ending, 150), times, {0});
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].verdict, verdict) << ending;
  }
}

TEST_F(Pictures, HeatOfWidePicturesKeepsItsBrightestPixel) {
  image::Image black(2000, 40), dot(2000, 40);
  for (int channel = 0; channel < 3; ++channel) dot.pixel(1001, 20)[channel] = 255;
  RunFiles a, b;
  a.pictures = {folder_ / "a_0.png"};
  b.pictures = {folder_ / "b_0.png"};
  image::write_png(a.pictures[0], black);
  image::write_png(b.pictures[0], dot);
  const auto pairs = compare_with_reference(a, {0, 1, 1, 0}, b, {0, 1, 1, 0}, {0});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].heat.width, 500);
  const image::Image whole = compare::heat_map(compare::compare(dot, black, 4).flip);
  // Pixel (1001, 20) belongs to the square of four by four pixels at (250, 5).
  EXPECT_GE(pairs[0].heat.pixel(250, 5)[0], whole.pixel(1001, 20)[0]);
}

}  // namespace
}  // namespace weft::review
