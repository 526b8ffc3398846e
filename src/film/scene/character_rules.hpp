// The rules of [[character]].
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& character_rules();

}  // namespace weft::scene
