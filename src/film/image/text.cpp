#include "film/image/text.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>

#include "core/error.hpp"

// The bytes of the font file. The build defines WEFT_FONT_FILE, its path.
asm(".pushsection .rodata\n"
    "weft_font_begin:\n"
    ".incbin \"" WEFT_FONT_FILE
    "\"\n"
    "weft_font_end:\n"
    ".popsection\n");
extern "C" const unsigned char weft_font_begin[], weft_font_end[];

namespace weft::image {
namespace {

constexpr char32_t kNoCharacter = 0xFFFD;

/// Removes the first character of a text and returns it, or kNoCharacter for an invalid byte.
char32_t next_character(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  char32_t character = length == 1 ? first : first & (0x7F >> length);
  bool whole = length > 0 && length <= text.size();
  for (std::size_t i = 1; whole && i < length; ++i) {
    whole = (byte(i) & 0xC0) == 0x80;
    character = character << 6 | (byte(i) & 0x3F);
  }
  text.remove_prefix(whole ? length : 1);
  return whole ? character : kNoCharacter;
}

/// Blends `color` over a pixel. `coverage`: from 0 (none) to 255 (full).
void blend(std::uint8_t* pixel, const Color& color, int coverage) {
  for (std::size_t c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - coverage) + color[c] * coverage + 127) / 255);
}

void check(FT_Error error) {
  if (error != 0) throw Error(ExitCode::internal, "text: the font cannot be used: FreeType error {}", error);
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  ~Face() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }

  /// Calls visit(glyph, x) for each character; x: its pen position [pixels]. Returns the position after the last one.
  template <class Visit>
  int layout(std::string_view text, FT_Int32 flags, const Visit& visit) const {
    int x = 0;
    while (!text.empty()) {
      check(FT_Load_Char(face, next_character(text), flags));
      visit(*face->glyph, x);
      x += static_cast<int>(face->glyph->advance.x >> 6);  // FreeType uses units of 1/64 pixel
    }
    return x;
  }
};

Font::Font(int pixels) : face_(std::make_unique<Face>()) {
  check(FT_Init_FreeType(&face_->library));
  check(FT_New_Memory_Face(face_->library, weft_font_begin, weft_font_end - weft_font_begin, 0, &face_->face));
  check(FT_Set_Pixel_Sizes(face_->face, 0, static_cast<FT_UInt>(std::clamp(pixels, 4, 400))));
}

Font::~Font() = default;

int Font::width(std::string_view text) const {
  return face_->layout(text, FT_LOAD_DEFAULT, [](const FT_GlyphSlotRec&, int) {});
}

void Font::draw(Image& image, int x, int baseline, std::string_view text, const Color& color) const {
  face_->layout(text, FT_LOAD_RENDER, [&](const FT_GlyphSlotRec& glyph, int pen) {
    const int left = x + pen + glyph.bitmap_left, top = baseline - glyph.bitmap_top;
    const int rows = static_cast<int>(glyph.bitmap.rows), columns = static_cast<int>(glyph.bitmap.width);
    for (int row = std::max(0, -top); row < std::min(rows, image.height - top); ++row)
      for (int column = std::max(0, -left); column < std::min(columns, image.width - left); ++column)
        blend(image.pixel(left + column, top + row), color, glyph.bitmap.buffer[row * glyph.bitmap.pitch + column]);
  });
}

}  // namespace weft::image
