// Kinds of interpolation between keys.
#pragma once

namespace weft::motion {

enum class Interpolation { linear, cubic };

}  // namespace weft::motion
