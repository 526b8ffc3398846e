// The rows of the rule table for [[character]].
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& character_rules();

}  // namespace weft::scene
