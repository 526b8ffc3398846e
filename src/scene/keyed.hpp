// Interpolation between keys.
#pragma once

namespace weft::scene {

enum class Interpolation { linear, cubic };

}  // namespace weft::scene
