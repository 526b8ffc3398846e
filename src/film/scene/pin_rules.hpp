// The rules for effects on parts of a cloth: pins, weights and attachments.
#pragma once

#include "film/scene/rule.hpp"

namespace weft::scene {

const Table& pin_rules();
const Table& weight_rules();
const Table& rope_pin_rules();
const Table& rope_weight_rules();
const Table& attachment_rules();

}  // namespace weft::scene
