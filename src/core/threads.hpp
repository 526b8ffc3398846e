// Arrangement of the threads of a cloth, for drawing.
#pragma once

namespace weft {

/// In the same order as in shaders/weave.glsl. `denim`: a twill with undyed weft. `none`: felt or leather.
enum class Threads { plain, twill, denim, knit, none };

}  // namespace weft
