// Edges of the faces as simulated, drawn over a finished picture.
#pragma once

#include <cstdint>
#include <span>

#include "render/seen.hpp"
#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

/// Darkens `picture`, as Outlines takes it, along the edges of those faces that `seen` shows there; lines are a pixel
/// wide and smooth. Surface i has the number kFirstSurface + i.
void draw_edges(std::span<const SurfaceBuffers> surfaces, const View& view, int width, int height,
                std::span<const Seen> seen, std::span<std::uint64_t> picture);

}  // namespace weft::render
