// Finds cloth that starts wholly inside a body. Such cloth touches nothing, so the simulation accepts the start, but
// contact then keeps the cloth inside.
#pragma once

#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"

namespace weft::cli {

/// Returns one sentence for each pair of a cloth and a closed, colliding obstacle that contains the cloth in
/// `snapshot`. Does not test ropes and characters.
std::vector<std::string> find_enclosed(const scene::Scene& scene, const frame::FrameSnapshot& snapshot);

}  // namespace weft::cli
