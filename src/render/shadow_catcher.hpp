// What of a picture compositors lay over a plate: its surfaces, and the shadow on its floor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/seen.hpp"

namespace weft::render {

/// Share of the floor's light that subjects take from it at each pixel: of `shaded` against `open`, the same floor
/// without shadows (both as read, lowest row first). Where a surface covers it, the most of what is beside, as part of
/// such a pixel may be floor.
std::vector<float> caught_shadows(std::span<const Seen> seen, std::span<const std::uint64_t> shaded,
                                  std::span<const std::uint64_t> open, int width, int height);

}  // namespace weft::render
