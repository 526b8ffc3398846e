// Smaller pictures, for contact sheets.
#pragma once

#include "film/image/image.hpp"

namespace weft::image {

/// Scales a picture down to `width` pixels and keeps its aspect ratio; a picture that is not wider stays unchanged.
/// Each new pixel is the mean of the pixels that it covers. The mean is of sRGB values, as in browsers.
Image shrink(const Image& image, int width);

}  // namespace weft::image
