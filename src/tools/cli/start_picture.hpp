// Pictures of the start of a scene, in which touching or crossing triangles are marked.
#pragma once

#include <vector>

#include "film/image/contact_sheet.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/render/renderer.hpp"
#include "tools/cli/stages.hpp"

namespace weft::cli {

/// Draws the whole scene, and close-ups of the first five places of `start`. Outlines the touching
/// or crossing triangles of all places in red, even if something hides them. `painter` must use the
/// first camera of each snapshot.
std::vector<image::SheetPicture> draw_start(const production::StartView& start, const render::Settings& settings,
                                            FramePainter& painter);

}  // namespace weft::cli
