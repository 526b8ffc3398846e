// Cloth worn over cloth: the order of dressing.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// Whether a cloth is worn over another, directly or through others. A name of no cloth is over nothing.
bool worn_over(const Scene& scene, const std::string& outer, const std::string& inner);

/// For each cloth, the maximum number of cloths worn below it, one over the other; 0 next to the skin.
std::vector<std::size_t> layer_depths(const Scene& scene);

/// A layer of cloths that is put on together.
struct Layer {
  int first_frame = 0;               ///< first frame of dressing; negative in the preroll
  std::vector<std::size_t> cloths;   ///< indices of the cloths of this layer
  std::vector<std::size_t> dressed;  ///< indices of the cloths of this and all lower layers, ascending
};

/// All layers from the skin outward, at least one. The layers share, evenly and in whole frames, the start of the
/// preroll: until the first of the characters with `dressing` moves.
std::vector<Layer> list_layers(const Scene& scene);

}  // namespace weft::scene
