// Counts differing pixels at edges, where another CPU type or Mesa version computes a sample on the other side of the
// edge.
#pragma once

#include <cstdint>

#include "image/image.hpp"

namespace weft::compare {

/// Counts the pixels over the tolerance in groups of at most 4 whose values also occur next to them in the other image:
/// each channel of the test lies, within the tolerance, between the smallest and the largest value of the 3x3 pixels of
/// the reference around it, and vice versa. A speck does not pass this test in one of the images; a moved edge makes a
/// larger group.
std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance);

}  // namespace weft::compare
