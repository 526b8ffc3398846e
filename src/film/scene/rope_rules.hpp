// The rows of the rule table for ropes.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& rope_rules();

}  // namespace weft::scene
