// Smaller pictures, for contact sheets.
#pragma once

#include "image/image.hpp"

namespace weft::image {

/// Scales a picture down to `width` pixels, keeping its aspect ratio; unchanged if it is not wider. Each new pixel is
/// the mean of the pixels that it covers, in sRGB values, as in browsers.
Image shrink(const Image& image, int width);

}  // namespace weft::image
