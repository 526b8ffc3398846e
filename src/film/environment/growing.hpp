// Changes wearers so that garments from patterns can be put on: arms go into the sleeves, or the body grows.
#pragma once

#include <optional>

#include "film/environment/environment.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// Returns a changed scene if the bones of an arm go through a garment from a pattern at the start. Its wearer then
/// stands with its arms in the sleeves or, if the garment has none, held off the body. A wearer is changed only if its
/// garment starts untangled, it has bones, `blend` and `dressing`, at least half of `dressing` lies before frame 0, and
/// the scene gives it no `stance_arms`. Returns nullopt if no wearer changes. Logs a note for each wearer that changes.
std::optional<scene::Scene> with_arms_in_sleeves(const scene::Scene& scene, const Environment& environment);

/// Returns a changed scene in which wearers grow from their bones during the first half of `dressing`. If the garment
/// has sleeves, `blend` is positive and the scene gives no `stance_arms`, their arms also point into the sleeves. A
/// wearer is changed only if its garment is from a pattern and starts untangled, it has bones and `dressing`, at least
/// half of `dressing` lies before frame 0, and the scene gives it no `grow`. Returns nullopt if no wearer changes. Logs
/// a note for each wearer that changes.
std::optional<scene::Scene> with_growing_wearers(const scene::Scene& scene, const Environment& environment);

}  // namespace weft::environment
