#include "film/image/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace weft::image {
namespace {

std::vector<SheetPicture> pictures(int count) {
  std::vector<SheetPicture> result;
  for (int i = 0; i < count; ++i) {
    Image image(60, 40);
    for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = static_cast<std::uint8_t>((k * 7 + i * 40) % 251);
    result.push_back({image, "1", "0 s"});
  }
  return result;
}

/// Position of the picture on the sheet, by exhaustive search; -1, -1 if it is not there.
std::array<int, 2> find(const Image& sheet, const Image& picture) {
  for (int y = 0; y + picture.height <= sheet.height; ++y) {
    for (int x = 0; x + picture.width <= sheet.width; ++x) {
      bool same = true;
      for (int row = 0; same && row < picture.height; ++row)
        same = std::equal(picture.pixel(0, row), picture.pixel(0, row) + 3 * picture.width, sheet.pixel(x, y + row));
      if (same) return {x, y};
    }
  }
  return {-1, -1};
}

TEST(ContactSheet, HoldsEveryPictureUnchangedInReadingOrder) {
  const auto all = pictures(5);
  const Image sheet = contact_sheet(all, 3, "heading");
  std::vector<std::array<int, 2>> places;
  for (const SheetPicture& picture : all) places.push_back(find(sheet, picture.image));
  for (int i = 0; i < 5; ++i) {
    const auto k = static_cast<std::size_t>(i);
    ASSERT_GE(places[k][0], 0) << i;
    EXPECT_EQ(places[k][0], places[i % 3][0]);
    EXPECT_EQ(places[k][1], places[i < 3 ? 0u : 3u][1]);
  }
  EXPECT_GT(places[1][0], places[0][0] + 60);
  EXPECT_GT(places[3][1], places[0][1] + 40);
}

TEST(ContactSheet, TextIsWrittenBesideThePicturesNotOnThem) {
  auto all = pictures(4);
  const Image with = contact_sheet(all, 2, "heading");
  for (SheetPicture& picture : all) picture.left = picture.right = "";
  const Image without = contact_sheet(all, 2, "");
  ASSERT_EQ(with.rgb.size(), without.rgb.size());
  EXPECT_NE(with.rgb, without.rgb);
  for (const SheetPicture& picture : all) EXPECT_EQ(find(with, picture.image), find(without, picture.image));
}

// Number of dark pixels (ink) in each row of the sheet below a picture, within the width of the picture.
std::vector<int> ink_below(const Image& sheet, const Image& picture) {
  const auto place = find(sheet, picture);
  std::vector<int> ink;
  for (int y = place[1] + picture.height; y < sheet.height; ++y) {
    int dark = 0;
    for (int x = place[0]; x < place[0] + picture.width; ++x) dark += sheet.pixel(x, y)[0] < 120;
    ink.push_back(dark);
  }
  return ink;
}

TEST(ContactSheet, CombiningAccentsFillNoLine) {
  auto all = pictures(1);
  all[0].left = "e";
  all[0].right = "";
  const int height = contact_sheet_size(all, 1).height;
  for (int i = 0; i < 200; ++i) all[0].left += "\u0301";
  EXPECT_EQ(contact_sheet_size(all, 1).height, height);
}

TEST(ContactSheet, WrapsLongTextAndCutsNothing) {
  auto all = pictures(1);
  const auto sum = [](const std::vector<int>& ink) {
    int all_ink = 0;
    for (int dark : ink) all_ink += dark;
    return all_ink;
  };
  all[0].right = "";
  all[0].left = "a=1";
  const int once = sum(ink_below(contact_sheet(all, 1, ""), all[0].image));
  ASSERT_GT(once, 10);
  const int short_sheet = contact_sheet(all, 1, "").height;
  // Two texts: separate words, and one word that is longer than a line.
  for (const char* blank : {" ", ""}) {
    all[0].left = "";
    for (int i = 0; i < 30; ++i) all[0].left += (i > 0 ? blank : "") + std::string("a=1");
    const Image sheet = contact_sheet(all, 1, "");
    EXPECT_GT(sheet.height, short_sheet + 5 * 11);
    // Tolerance: letters begin at fractions of pixels, so their ink differs (measured: up to 4 %).
    EXPECT_NEAR(sum(ink_below(sheet, all[0].image)), 30 * once, 0.1 * 30 * once) << '"' << blank << '"';
  }
}

TEST(ContactSheet, StaysLowUnderLongTexts) {
  auto all = pictures(1);
  all[0].left = std::string(100'000, 'x');
  EXPECT_LT(contact_sheet(all, 1, "").height, 1000);
}

TEST(ContactSheet, IsNoWiderThanItsPictures) {
  EXPECT_EQ(contact_sheet(pictures(2), 9, "").width, contact_sheet(pictures(2), 2, "").width);
  EXPECT_LT(contact_sheet(pictures(2), 1, "").width, contact_sheet(pictures(2), 2, "").width);
}

}  // namespace
}  // namespace weft::image
