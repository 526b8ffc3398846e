// Changes wearers so that garments from patterns can be put on: arms go into the sleeves, or the body grows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// Returns a changed scene if the bones of an arm go through a garment from a pattern at the start. In this scene, the
/// wearer of the garment starts with the arms in the sleeves or, if there are no sleeves, away from the body. Changes a
/// wearer only if
/// - the garment is untangled at the start (scene::starts_untangled),
/// - the wearer has bones, a positive `blend`, and no `stance_arms` in the scene,
/// - the wearer has a positive `dressing`, and at least half of this time is before frame 0.
/// Returns nullopt if no wearer changes. Logs a note for each garment whose wearer changes.
std::optional<scene::Scene> pose_arms_for_sleeves(const scene::Scene& scene, const Environment& environment);

/// Returns a changed scene in which wearers grow from their bones during the first half of `dressing`. If the garment
/// has sleeves, and the wearer has a positive `blend` and no `stance_arms` in the scene, the arms also point into the
/// sleeves. Changes a wearer only if
/// - its garment is from a pattern and untangled at the start,
/// - the wearer has bones, and no `grow` in the scene,
/// - the wearer has a positive `dressing`, and at least half of this time is before frame 0.
/// Returns nullopt if no wearer changes. Adds a note to `notes` for each garment whose wearer changes.
std::optional<scene::Scene> let_wearers_grow(const scene::Scene& scene, const Environment& environment,
                                             std::vector<std::string>& notes);

}  // namespace weft::environment
