// Which of the pixels that differ lie on an edge, where another CPU or Mesa puts a sample on the other side of it.
#pragma once

#include <cstdint>

#include "image/image.hpp"

namespace weft::compare {

/// Counts the pixels over the tolerance in groups of at most 4 whose values can be seen beside them in the other image:
/// each channel of the test is, to the tolerance, between the least and the largest value of the 3x3 pixels of the
/// reference around it, and the reverse. A speck fails this in one of the two images, an edge that moves makes a longer
/// group.
std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance);

}  // namespace weft::compare
