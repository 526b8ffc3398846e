// How values with keys go from one key to the next.
#pragma once

namespace weft::scene {

enum class Interpolation { linear, cubic };

}  // namespace weft::scene
