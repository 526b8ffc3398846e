// A contact sheet: many small pictures on one.
#pragma once

#include <span>
#include <string>

#include "film/image/image.hpp"

namespace weft::image {

struct SheetPicture {
  Image image;
  std::string left, right;  ///< caption: `left` can take several lines, `right` is at the end of the last line
};

/// Lays out pictures of one size in rows under a heading. The size of the text is proportional to the width of the
/// pictures, within limits.
Image contact_sheet(std::span<const SheetPicture> pictures, int columns, const std::string& heading);

}  // namespace weft::image
