// Structural similarity: Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment: from error visibility to
// structural similarity", 2004.
#pragma once

#include <cstdint>

#include "film/image/image.hpp"
#include "tools/compare/plane.hpp"

namespace weft::compare {

/// Mean SSIM (Eqs. 13 and 17) of the luma Y' = 0.2126 R' + 0.7152 G' + 0.0722 B': 1 for equal images, less if structure
/// differs. Uses Gaussian windows of 11x11 pixels with sigma 1.5 [pixels], inside the image; K1 = 0.01, K2 = 0.03. If a
/// side has fewer than 11 pixels, the windows along this side are centred on all pixels, and border pixels are
/// repeated. Both images must have the same size. `mask`: the mean is that of the windows centred on pixels whose value
/// is not 0, of which there must be one; null: of all windows.
double structural_similarity(const image::Image& reference, const image::Image& test,
                             const Plane<std::uint8_t>* mask = nullptr);

}  // namespace weft::compare
