// The rules for air enclosed by a cloth.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& pressure_rules();

}  // namespace weft::scene
