// Cloth worn over cloth: the order in which garments are put on.
#pragma once

#include <string>
#include <vector>

#include "film/scene/scene.hpp"
#include "physics/model/model.hpp"

namespace weft::scene {

/// Whether the cloth `outer` is worn over the cloth `inner`, directly or through other cloths. False if no cloth has
/// the name `outer`.
bool worn_over(const Scene& scene, const std::string& outer, const std::string& inner);

using model::Layer;

/// All layers from the skin outward, at least one. The layers are put on one after the other, at the beginnings of
/// equal intervals, rounded to frames. The first interval begins at the start of the preroll. The last interval ends
/// with the preroll or, if this is earlier, after the shortest nonzero `dressing` of a character.
std::vector<Layer> list_layers(const Scene& scene);

}  // namespace weft::scene
