// The shadow of the surfaces on the floor, which compositors lay over a photograph together with the surfaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "film/render/seen.hpp"

namespace weft::render {

/// Fraction of the floor's light that the subjects block, per pixel. `shaded`: the picture; `open`:
/// the same picture with unshadowed floor (both as read from OpenGL, lowest row first). A pixel
/// that shows no floor gets the maximum of those of its eight neighbours that show floor, because
/// part of the pixel may be floor; 0 if there are none.
std::vector<float> floor_shadows(std::span<const Seen> seen, std::span<const std::uint64_t> shaded,
                                 std::span<const std::uint64_t> open, int width, int height);

}  // namespace weft::render
