#include "image/contact_sheet.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "image/text.hpp"

namespace weft::image {
namespace {

constexpr Color kPaper{244, 244, 242}, kInk{38, 38, 42}, kFaintInk{112, 112, 118};

/// Sizes that follow from the width of a picture [pixels].
struct Layout {
  explicit Layout(int width)
      : text(std::clamp(width / 24, 9, 28)), heading(text * 4 / 3), gap(text), caption(text * 2) {}
  int text, heading;
  int gap;      // around pictures
  int caption;  // height of the line below each
};

void paste(Image& onto, const Image& image, int x, int y) {
  for (int row = 0; row < image.height; ++row)
    std::copy_n(image.pixel(0, row), 3 * static_cast<std::size_t>(image.width), onto.pixel(x, y + row));
}

// As much of the text as there is room for.
std::string fitting(const Font& font, std::string text, int room) {
  if (font.width(text) <= room) return text;
  while (!text.empty() && font.width(text + "…") > room) {
    while (text.size() > 1 && (text.back() & 0xC0) == 0x80) text.pop_back();  // the rest of a character of UTF-8
    text.pop_back();
  }
  return text + "…";
}

}  // namespace

Image contact_sheet(std::span<const SheetPicture> pictures, int columns, const std::string& heading) {
  if (pictures.empty() || columns < 1) throw Error(ExitCode::internal, "contact sheet: expected pictures and columns");
  const int width = pictures[0].image.width, height = pictures[0].image.height;
  columns = std::min(columns, static_cast<int>(pictures.size()));
  const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
  const Layout layout(width);
  const int top = 2 * layout.gap + layout.heading;

  Image sheet(layout.gap + columns * (width + layout.gap), top + rows * (height + layout.caption) + layout.gap / 2);
  for (std::size_t i = 0; i < sheet.rgb.size(); ++i) sheet.rgb[i] = kPaper[i % 3];
  const Font heading_font(layout.heading), font(layout.text);
  heading_font.draw(sheet, layout.gap, layout.gap + layout.heading * 4 / 5, heading, kInk);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const SheetPicture& picture = pictures[i];
    if (picture.image.width != width || picture.image.height != height)
      throw Error(ExitCode::internal, "contact sheet: expected pictures of one size");
    const int x = layout.gap + static_cast<int>(i) % columns * (width + layout.gap);
    const int y = top + static_cast<int>(i) / columns * (height + layout.caption);
    paste(sheet, picture.image, x, y);
    const int baseline = y + height + layout.text * 5 / 4;
    const int right = font.width(picture.right);
    font.draw(sheet, x, baseline, fitting(font, picture.left, width - right - layout.gap / 2), kInk);
    font.draw(sheet, x + width - right, baseline, picture.right, kFaintInk);
  }
  return sheet;
}

}  // namespace weft::image
