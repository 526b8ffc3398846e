// The rules of [[rope]].
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& rope_rules();

}  // namespace weft::scene
