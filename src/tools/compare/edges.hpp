// Counts differing pixels at edges. With another CPU type or Mesa version, a sample of a pixel can fall on the other
// side of an edge.
#pragma once

#include <cstdint>

#include "film/image/image.hpp"

namespace weft::compare {

/// Counts the pixels that differ by more than `tolerance` and fulfil two conditions. (1) The pixel
/// belongs to a group of at most 4 pixels over the tolerance that are neighbours in a row, column
/// or diagonal; an edge that moved makes a larger group. (2) In each image, each channel of the
/// pixel lies, within the tolerance, between the smallest and the largest value of the 3x3 pixels
/// around the same place in the other image; this excludes a spot that only one image has.
std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance);

}  // namespace weft::compare
