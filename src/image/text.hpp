// Text on pictures, in a font that is part of the program: none can be missing where it runs.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "image/image.hpp"

namespace weft::image {

using Color = std::array<std::uint8_t, 3>;  ///< sRGB

/// DejaVu Sans in one size. Text is UTF-8; what is none, and characters the font does not have, show as boxes.
class Font {
 public:
  /// `pixels`: of the em square, 4 to 400.
  explicit Font(int pixels);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  int width(std::string_view text) const;  ///< [pixels]

  /// Draws a line that starts at x on this baseline; what lies outside the picture is left out.
  void draw(Image& image, int x, int baseline, std::string_view text, const Color& color) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
};

}  // namespace weft::image
