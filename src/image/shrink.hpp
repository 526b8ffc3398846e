// Smaller pictures, for sheets.
#pragma once

#include "image/image.hpp"

namespace weft::image {

/// The picture at `width` pixels in its own shape; as it is where it is not wider. Each new pixel is the mean of those
/// that it covers, in sRGB as browsers do it.
Image shrink(const Image& image, int width);

}  // namespace weft::image
