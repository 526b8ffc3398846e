// Cloth worn over cloth: in which order it is put on.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// Whether a cloth is worn over another, or over one that is, and so on. Names that no cloth has are over nothing.
bool worn_over(const Scene& scene, const std::string& outer, const std::string& inner);

/// Of each cloth the most cloths that are worn below it, one over the other; 0 next to the skin.
std::vector<std::size_t> layers_of(const Scene& scene);

/// When a layer is put on.
struct Layer {
  int first_frame = 0;               ///< negative in the preroll
  std::vector<std::size_t> cloths;   ///< of it, by number
  std::vector<std::size_t> dressed;  ///< of it and of those below, by ascending number
};

/// All layers from the skin outward, at least one. They share evenly, in whole frames, the part of the preroll in which
/// all characters that stand still at its start do so.
std::vector<Layer> list_layers(const Scene& scene);

}  // namespace weft::scene
