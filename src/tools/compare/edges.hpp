// Counts differing pixels at edges. With another CPU type or Mesa version, a sample near an edge can fall on the other
// side of it.
#pragma once

#include <cstdint>

#include "film/image/image.hpp"

namespace weft::compare {

/// Counts the pixels over the tolerance that are in groups of at most 4 such pixels and whose values in both images fit
/// into the other image. A value fits into the other image if each channel lies, within the tolerance, between the
/// smallest and the largest value of the 3x3 pixels around the same place. This excludes a speck, which fits only into
/// its own image, and a moved edge, which makes a larger group.
std::int64_t count_at_edges(const image::Image& reference, const image::Image& test, int tolerance);

}  // namespace weft::compare
