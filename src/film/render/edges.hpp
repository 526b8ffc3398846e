// Edges of the simulated faces, drawn over a finished picture.
#pragma once

#include <cstdint>
#include <span>

#include "film/render/seen.hpp"
#include "film/render/surface_buffers.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// Darkens `picture` (RGBA with 16 bits per channel, lowest row first) along those edges of faces that are visible
/// according to `seen`, in which surface i has the number kFirstSurface + i. Lines are one pixel wide and antialiased.
void draw_edges(std::span<const SurfaceBuffers> surfaces, const View& view, int width, int height,
                std::span<const Seen> seen, std::span<std::uint64_t> picture);

}  // namespace weft::render
