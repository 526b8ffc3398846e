// Fabrics by name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

struct Fabric {
  Material material;  ///< its `fabric` is the name
  std::string note;   ///< what it is and where its figures come from
};

/// All named fabrics; the first is the default and equals Material{}.
std::span<const Fabric> fabrics();
const Fabric* find_fabric(std::string_view name);
std::vector<std::string> fabric_names();

}  // namespace weft::scene
