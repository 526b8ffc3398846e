// Smaller pictures, for contact sheets.
#pragma once

#include "film/image/image.hpp"

namespace weft::image {

/// Scales a picture down to `width` pixels and keeps its aspect ratio; a picture that is not wider stays unchanged.
/// Each new pixel is the mean of the pixels that it covers. Like browsers, takes the mean of sRGB values.
Image shrink(const Image& image, int width);

}  // namespace weft::image
