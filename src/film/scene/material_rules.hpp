// The rules for the material of a cloth.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& material_rules();

}  // namespace weft::scene
