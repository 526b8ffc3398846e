// A contact sheet: many small pictures on one large picture.
#pragma once

#include <span>
#include <string>

#include "film/image/image.hpp"

namespace weft::image {

/// A picture of a contact sheet, and its caption.
struct SheetPicture {
  Image image;
  std::string left, right;  ///< parts of the caption: `left` is wrapped to lines, `right` ends the last line
};

/// Size of a contact sheet [pixels].
struct SheetSize {
  int width = 0, height = 0;
  int row = 0;  ///< height of a row of pictures with their captions

  /// Whether write_png() can write a sheet of this size.
  bool is_writable() const;
};

/// Size of the sheet that contact_sheet() makes of `pictures` (at least one) in `columns` columns (at least 1). Does
/// not read the pixels of the pictures.
SheetSize contact_sheet_size(std::span<const SheetPicture> pictures, int columns);

/// Lays out pictures of one size in rows under a heading. The size of the text is proportional to the width of the
/// pictures, within limits. Throws Error(internal) if `pictures` is empty, the sizes differ or `columns` is below 1.
Image contact_sheet(std::span<const SheetPicture> pictures, int columns, const std::string& heading);

}  // namespace weft::image
