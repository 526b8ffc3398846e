// Text on pictures, in a font that is built into the program.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "film/image/image.hpp"

namespace weft::image {

using Color = std::array<std::uint8_t, 3>;  ///< sRGB

/// The font DejaVu Sans in one size. Text is UTF-8. An invalid byte is drawn as U+FFFD (a question mark in a rhombus),
/// and a character that the font lacks as a box.
class Font {
 public:
  /// `pixels`: side of the em square [pixels], clamped to the range from 4 to 400.
  explicit Font(int pixels);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  int width(std::string_view text) const;  ///< width of a line of text [pixels]

  /// Draws a line of text that starts at column `x` and stands on row `baseline` [pixels], clipped to the picture.
  void draw(Image& image, int x, int baseline, std::string_view text, const Color& color) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
};

}  // namespace weft::image
