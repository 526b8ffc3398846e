#include "film/scene/layers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace weft::scene {
namespace {

// Adds the names of all cloths that are below the cloth `name` to `below`.
void add_below(const Scene& scene, const std::string& name, std::set<std::string>& below) {
  for (const Cloth& cloth : scene.cloths)
    if (cloth.name == name)
      for (const std::string& next : cloth.over)
        if (below.insert(next).second) add_below(scene, next, below);
}

// Number of frames in which the layers are put on; see list_layers().
int dressing_frames(const Scene& scene) {
  int frames = scene.preroll_frames();
  for (const Character& character : scene.characters)
    if (character.dressing > 0)
      frames = std::min(frames, static_cast<int>(character.dressing * scene.time.fps + kRoundoff));
  return frames;
}

// The number of layers below each cloth: the number of other cloths in the longest chain that begins with this cloth
// and in which each cloth is worn over the next one.
std::vector<std::size_t> layer_depths(const Scene& scene) {
  std::vector<std::size_t> layers(scene.cloths.size(), 0);
  // One pass per cloth is enough: a chain without a cycle contains each cloth at most once. check_layers() (checks.cpp)
  // reports cycles.
  bool has_changed = true;
  for (std::size_t pass = 0; has_changed && pass < scene.cloths.size(); ++pass) {
    has_changed = false;
    for (std::size_t c = 0; c < scene.cloths.size(); ++c)
      for (const std::string& name : scene.cloths[c].over) {
        const auto below = std::ranges::find(scene.cloths, name, &Cloth::name);
        if (below == scene.cloths.end()) continue;
        const std::size_t depth = layers[static_cast<std::size_t>(below - scene.cloths.begin())] + 1;
        if (depth <= layers[c]) continue;
        layers[c] = depth;
        has_changed = true;
      }
  }
  return layers;
}

}  // namespace

bool worn_over(const Scene& scene, const std::string& outer, const std::string& inner) {
  std::set<std::string> below;
  add_below(scene, outer, below);
  return below.contains(inner);
}

std::vector<Layer> list_layers(const Scene& scene) {
  const std::vector<std::size_t> layer_of = layer_depths(scene);
  std::vector<Layer> layers(layer_of.empty() ? 1 : 1 + *std::ranges::max_element(layer_of));
  for (std::size_t k = 0; k < layers.size(); ++k) {
    layers[k].first_frame =
        -scene.preroll_frames() + dressing_frames(scene) * static_cast<int>(k) / static_cast<int>(layers.size());
    for (std::size_t c = 0; c < layer_of.size(); ++c) {
      if (layer_of[c] == k) layers[k].cloths.push_back(c);
      if (layer_of[c] <= k) layers[k].put_on.push_back(c);
    }
  }
  return layers;
}

}  // namespace weft::scene
