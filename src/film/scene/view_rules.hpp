// The rules for cameras, lights and the picture.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& camera_rules();
const Table& light_rules();
const Table& render_rules();

}  // namespace weft::scene
