#include "film/image/contact_sheet.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "film/image/png.hpp"
#include "film/image/text.hpp"

namespace weft::image {
namespace {

// Colours of the background, of text, and of SheetPicture::right.
constexpr Color kBackgroundColor{244, 244, 242}, kTextColor{38, 38, 42}, kFaintTextColor{112, 112, 118};

/// Sizes derived from the width of a picture [pixels].
struct Layout {
  explicit Layout(int width)
      : text(std::clamp(width / 24, 9, 28)), heading(text * 4 / 3), gap(text), caption(text * 2) {}
  int text, heading;
  int gap;      // space around pictures
  int caption;  // height of the first line below each picture
  int line() const { return text * 5 / 4; }
};

void paste(Image& onto, const Image& image, int x, int y) {
  for (int row = 0; row < image.height; ++row)
    std::copy_n(image.pixel(0, row), 3 * static_cast<std::size_t>(image.width), onto.pixel(x, y + row));
}

// Length [bytes] of the longest prefix of `text` that fits into `max_width` [pixels]; at least one character.
std::size_t find_fitting_length(const Font& font, std::string_view text, int max_width) {
  std::size_t length = 0;
  for (int width = 0; length < text.size();) {
    std::size_t next = length + 1;
    while (next < text.size() && (text[next] & 0xC0) == 0x80) ++next;  // continuation bytes of UTF-8
    width += font.width(text.substr(length, next - length));
    if (length > 0 && width > max_width) break;
    length = next;
  }
  return length;
}

// Maximum number of lines of SheetPicture::left; if it needs more, "…" replaces the rest. Limits the height of a sheet.
constexpr std::size_t kMaxCaptionLines = 60;

// Wraps a text at blanks to lines no wider than `max_width` [pixels]; splits a word that is longer than a line.
std::vector<std::string> wrap_text(const Font& font, std::string_view text, int max_width) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    if (lines.size() == kMaxCaptionLines) {
      lines.back() = "…";
      break;
    }
    std::size_t length = find_fitting_length(font, text, max_width);
    const std::size_t blank = length < text.size() ? text.rfind(' ', length) : std::string_view::npos;
    if (blank != std::string_view::npos && blank > 0) length = blank;
    const std::string_view line = text.substr(0, length);
    lines.emplace_back(line.substr(0, line.find_last_not_of(' ') + 1));
    text.remove_prefix(length);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  }
  return lines;
}

// The lines of `picture.left`. Appends an empty line if `picture.right` does not fit into the last line.
std::vector<std::string> caption_lines(const Font& font, const SheetPicture& picture, int width, int gap) {
  std::vector<std::string> lines = wrap_text(font, picture.left, width);
  if (lines.empty() || font.width(lines.back()) + gap + font.width(picture.right) > width) lines.emplace_back();
  return lines;
}

/// Size and captions of a sheet; `top`: distance of the first row of pictures from the upper edge [pixels].
struct Plan {
  Plan(std::span<const SheetPicture> pictures, int wanted_columns) : layout(pictures[0].image.width) {
    columns = std::min(wanted_columns, static_cast<int>(pictures.size()));
    const int width = pictures[0].image.width;
    const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    const Font font(layout.text);
    std::size_t max_lines = 1;
    for (const SheetPicture& picture : pictures) {
      captions.push_back(caption_lines(font, picture, width, layout.gap / 2));
      max_lines = std::max(max_lines, captions.back().size());
    }
    top = 2 * layout.gap + layout.heading;
    size.row = pictures[0].image.height + layout.caption + (static_cast<int>(max_lines) - 1) * layout.line();
    size.width = layout.gap + columns * (width + layout.gap);
    size.height = top + rows * size.row + layout.gap / 2;
  }

  Layout layout;
  int columns = 1, top = 0;
  std::vector<std::vector<std::string>> captions;
  SheetSize size;
};

}  // namespace

bool SheetSize::is_writable() const {
  return width <= kMaxPngSide && height <= kMaxPngSide;
}

SheetSize contact_sheet_size(std::span<const SheetPicture> pictures, int columns) {
  return Plan(pictures, columns).size;
}

Image contact_sheet(std::span<const SheetPicture> pictures, int columns, const std::string& heading) {
  if (pictures.empty() || columns < 1) throw Error(ExitCode::internal, "contact sheet: expected pictures and columns");
  const int width = pictures[0].image.width, height = pictures[0].image.height;
  const Plan plan(pictures, columns);
  const Layout& layout = plan.layout;
  const Font heading_font(layout.heading), font(layout.text);
  Image sheet(plan.size.width, plan.size.height);
  for (std::size_t i = 0; i < sheet.rgb.size(); ++i) sheet.rgb[i] = kBackgroundColor[i % 3];
  heading_font.draw(sheet, layout.gap, layout.gap + layout.heading * 4 / 5, heading, kTextColor);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const SheetPicture& picture = pictures[i];
    if (picture.image.width != width || picture.image.height != height)
      throw Error(ExitCode::internal, "contact sheet: expected pictures of one size");
    const int x = layout.gap + static_cast<int>(i) % plan.columns * (width + layout.gap);
    const int y = plan.top + static_cast<int>(i) / plan.columns * plan.size.row;
    paste(sheet, picture.image, x, y);
    int baseline = y + height;
    for (const std::string& line : plan.captions[i]) font.draw(sheet, x, baseline += layout.line(), line, kTextColor);
    font.draw(sheet, x + width - font.width(picture.right), baseline, picture.right, kFaintTextColor);
  }
  return sheet;
}

}  // namespace weft::image
