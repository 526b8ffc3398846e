// Poses wearers so that garments from patterns can be put on them: arms in the sleeves, or a body that grows.
#pragma once

#include <optional>

#include "film/environment/environment.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// The scene in which wearers whose arm bones go through a garment from a pattern stand with their arms in its sleeves
/// or, beside garments without sleeves, held off the body. Absent if no wearer needs it, or may: its garment is not
/// untangled, it has no bones, no `dressing` before frame 0 or no `blend`, or the scene gives `stance_arms`. Reports
/// each wearer that it changes.
std::optional<scene::Scene> with_arms_in_sleeves(const scene::Scene& scene, const Environment& environment);

/// The scene in which the wearers of such garments grow from their bones in the first half of `dressing`, with
/// their arms in the sleeves, if there are any and the scene does not give `stance_arms`. Absent if no wearer may grow,
/// or the scene says how all grow. Reports each wearer that it changes.
std::optional<scene::Scene> with_growing_wearers(const scene::Scene& scene, const Environment& environment);

}  // namespace weft::environment
