// Pictures of scenes: masks of pins, prints on cloth.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>
#include <weft/api.hpp>

namespace weft {

struct Picture {
  int width = 0, height = 0;       ///< [pixels]
  std::vector<std::uint8_t> rgba;  ///< rows from the top, bytes R G B A per pixel, sRGB, alpha not premultiplied
};

/// Sets the decoder of pictures. The library has none of its own, so that it needs no image libraries. A scene with
/// pictures (masks of pins, prints on cloth) needs a decoder of PNG, JPEG or TGA. `decode` gets the bytes of a file; it
/// must throw std::runtime_error with the reason if it cannot decode them.
WEFT_API void set_picture_decoder(std::function<Picture(std::string_view bytes)> decode);

}  // namespace weft
