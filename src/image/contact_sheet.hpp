// Many small pictures on one.
#pragma once

#include <span>
#include <string>

#include "image/image.hpp"

namespace weft::image {

struct SheetPicture {
  Image image;
  std::string left, right;  ///< written below it: `left` in as many lines as it needs, `right` at the end of the last
};

/// Lays out pictures of one size row by row, under a heading. The text grows with the pictures.
Image contact_sheet(std::span<const SheetPicture> pictures, int columns, const std::string& heading);

}  // namespace weft::image
