// Counts differing pixels at edges: on another CPU type or Mesa version, a sample there can be on the other side of the
// edge.
#pragma once

#include <cstdint>

#include "film/image/image.hpp"

namespace weft::compare {

/// Counts the pixels over the tolerance that are in groups of at most 4 pixels and whose values fit to their
/// surroundings in the other image: each channel of the test lies, within the tolerance, between the smallest and the
/// largest value of the 3x3 pixels of the reference around it, and vice versa. A speck does not fit in one of the
/// images; a moved edge makes a larger group.
std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance);

}  // namespace weft::compare
