// The rows of the rule table for air inside a cloth.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& pressure_rules();

}  // namespace weft::scene
