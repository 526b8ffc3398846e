// Detection of cloth that starts wholly inside a body: it touches nothing and never comes out.
#pragma once

#include <string>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::cli {

/// Returns a sentence for each cloth that is inside a closed obstacle in this frame.
std::vector<std::string> find_enclosed(const scene::Scene& scene, const frame::FrameSnapshot& snapshot);

}  // namespace weft::cli
