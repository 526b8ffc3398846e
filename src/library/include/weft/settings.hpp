// Settings of the whole process. Set them before the first scene is loaded.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>
#include <weft/api.hpp>

namespace weft {

/// Version of the library: "0.1.0".
WEFT_API const char* version();

/// Sets the largest number of threads; 0: as many as there are processors. Results do not depend on it.
WEFT_API void set_threads(int threads);

/// Sends each warning and note about a scene to `handle`, instead of standard error. `handle` is called by the thread
/// that loads or simulates. If several threads do so, calls may be concurrent. An empty function restores standard
/// error.
WEFT_API void set_warning_handler(std::function<void(std::string_view warning)> handle);

struct Picture {
  int width = 0, height = 0;       ///< [pixels]
  std::vector<std::uint8_t> rgba;  ///< rows from the top, bytes R G B A per pixel, sRGB, alpha not premultiplied
};

/// Sets the decoder of pictures. The library has none of its own, so that it needs no image libraries. A scene with
/// pictures (masks of pins, prints on cloth) needs a decoder of PNG, JPEG or TGA. `decode` gets the bytes of a file; it
/// must throw std::runtime_error with the reason if it cannot decode them.
WEFT_API void set_picture_decoder(std::function<Picture(std::string_view bytes)> decode);

}  // namespace weft
