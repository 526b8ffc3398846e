// The rules of [contact] and its inner tables.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& contact_rules();

}  // namespace weft::scene
