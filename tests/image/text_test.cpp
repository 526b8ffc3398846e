#include "film/image/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace weft::image {
namespace {

constexpr Color kWhite{255, 255, 255};

/// First and last column and row that are not black; -1 if all pixels are black.
struct Ink {
  int left = -1, right = -1, top = -1, bottom = -1;

  explicit Ink(const Image& image) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (*image.pixel(x, y) == 0) continue;
        left = left < 0 ? x : std::min(left, x);
        right = std::max(right, x);
        top = top < 0 ? y : top;
        bottom = y;
      }
    }
  }
};

Ink ink_of(const std::string& text, int x = 50, int baseline = 50) {
  Image image(300, 100);
  Font(20).draw(image, x, baseline, text, kWhite);
  return Ink(image);
}

TEST(Text, LettersStandOnTheirLineWithinTheirWidth) {
  const Ink ink = ink_of("frame 12  H");
  EXPECT_GE(ink.left, 50);
  EXPECT_LT(ink.right, 50 + Font(20).width("frame 12  H"));
  EXPECT_EQ(ink.bottom, 49) << "nothing hangs below the line";
  EXPECT_GE(ink.top, 50 - 19);  // letters of DejaVu Sans rise 0.928 em above the baseline
  EXPECT_GT(ink_of("gp").bottom, 49) << "these letters do hang below it";
  // Capitals of DejaVu Sans are 0.729 em high: 14.6 pixels.
  EXPECT_NEAR(50 - ink_of("H").top, 14.6, 1);
}

TEST(Text, DigitsAreOfOneWidth) {
  for (const char* digit : {"1", "4", "8"}) EXPECT_EQ(Font(17).width(digit), Font(17).width("0"));
}

TEST(Text, CharactersMayTakeSeveralBytesAndBrokenOnesShowAsBoxes) {
  const Font font(20);
  EXPECT_EQ(font.width("é"), font.width("e"));
  EXPECT_EQ(font.width("Ωπ"), font.width("Ω") + font.width("π"));
  const int box = font.width("\xEF\xBF\xBD");  // U+FFFD
  for (const char* broken : {"\xFF", "\x80", "\xC3", "\xC0"}) EXPECT_EQ(font.width(broken), box) << broken;
  EXPECT_EQ(font.width("\xC3g"), box + font.width("g")) << "what follows a broken character is lost";
  EXPECT_EQ(font.width(""), 0);
}

TEST(Text, WhatLiesOutsideThePictureIsLeftOut) {
  for (const auto& [x, baseline] : {std::pair(-30, 50), {280, 50}, {50, 3}, {50, 110}, {-5000, 50}, {50, 5000}})
    EXPECT_NO_THROW(ink_of("Weft", x, baseline));
  EXPECT_EQ(ink_of("Weft", -30).left, 0);
  EXPECT_EQ(ink_of("Weft", 280).right, 299);
  EXPECT_EQ(ink_of("Weft", -5000).left, -1);
}

TEST(Text, EdgesAreBlendedWithWhatIsBehind) {
  Image image(40, 40);
  std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{100});
  Font(30).draw(image, 5, 35, "O", {200, 100, 0});
  bool between = false;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const std::uint8_t* pixel = image.pixel(x, y);
      EXPECT_NEAR(pixel[0] - 100, 100 - pixel[2], 1) << "rounding of two channels";
      EXPECT_EQ(pixel[1], 100);
      between = between || (pixel[0] > 120 && pixel[0] < 180);
    }
  }
  EXPECT_TRUE(between);
}

}  // namespace
}  // namespace weft::image
