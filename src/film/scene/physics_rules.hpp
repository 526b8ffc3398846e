// The rules for gravity and air.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& physics_rules();
const Table& fan_rules();

}  // namespace weft::scene
