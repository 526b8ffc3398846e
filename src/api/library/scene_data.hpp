// The private data of the public scene, for the library and the Python module.
#pragma once

#include <filesystem>
#include <string>
#include <vector>
#include <weft/scene.hpp>

#include "film/scene/scene.hpp"

namespace weft {

struct Scene::Data {
  scene::Scene scene;
  std::string text;            ///< TOML without the changes
  std::filesystem::path file;  ///< path as given by the caller
  std::vector<std::string> changes;
};

}  // namespace weft
