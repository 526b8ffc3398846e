// Pictures of scenes: masks of pins, prints on cloth.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>
#include <weft/api.hpp>

namespace weft {

struct Picture {
  int width = 0, height = 0;       ///< from 1 to 16384 [pixels]
  std::vector<std::uint8_t> rgba;  ///< bytes R G B A of each pixel, top row first; sRGB, alpha not premultiplied
};

/// Sets the decoder of PNG, JPEG or TGA files, which scenes with pictures need. The library has no decoder of its own,
/// so that it needs no image libraries. `decode` gets the bytes of a file. If `decode` cannot decode them, it must
/// throw std::runtime_error with the reason.
WEFT_API void set_picture_decoder(std::function<Picture(std::string_view bytes)> decode);

}  // namespace weft
