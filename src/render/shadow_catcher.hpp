// The parts of a picture that compositors lay over a plate: surfaces, and their shadow on the floor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/seen.hpp"

namespace weft::render {

/// Fraction of the floor's light that the subjects block at each pixel: `shaded` compared with `open`, the same floor
/// without shadows (both as read, lowest row first). Pixels covered by a surface take the maximum of their neighbours,
/// because part of such a pixel may be floor.
std::vector<float> floor_shadows(std::span<const Seen> seen, std::span<const std::uint64_t> shaded,
                                 std::span<const std::uint64_t> open, int width, int height);

}  // namespace weft::render
