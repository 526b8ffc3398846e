#include "image/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace weft::image {
namespace {

std::vector<SheetPicture> pictures(int count) {
  std::vector<SheetPicture> result;
  for (int i = 0; i < count; ++i) {
    Image image(60, 40);
    for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = static_cast<std::uint8_t>((k * 7 + i * 40) % 251);
    result.push_back({image, "frame", "0.00 s"});
  }
  return result;
}

/// Where the picture lies on the sheet, by trying every place; -1, -1 where nowhere.
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

TEST(ContactSheet, IsNoWiderThanItsPictures) {
  EXPECT_EQ(contact_sheet(pictures(2), 9, "").width, contact_sheet(pictures(2), 2, "").width);
  EXPECT_LT(contact_sheet(pictures(2), 1, "").width, contact_sheet(pictures(2), 2, "").width);
}

}  // namespace
}  // namespace weft::image
