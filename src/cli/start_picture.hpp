// The start of a scene, with what touches or crosses marked, from sides that show it.
#pragma once

#include <vector>

#include "cli/stages.hpp"
#include "image/contact_sheet.hpp"
#include "render/renderer.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {

/// The whole as the scene's camera sees it, or framed automatically, and the places of most pairs from near; triangles
/// that meet are outlined in red, also where something hides them.
/// The painter draws what its snapshots' first camera sees.
std::vector<image::SheetPicture> draw_start(const simulation::StartView& start, const render::Settings& settings,
                                            FramePainter& painter);

}  // namespace weft::cli
