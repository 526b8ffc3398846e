// Structure of the threads of a cloth, as it is drawn.
#pragma once

namespace weft {

/// In the same order as in shaders/weave.glsl. `denim`: a twill with undyed weft. `none`: felt or leather.
enum class Threads { plain, twill, denim, knit, none };

}  // namespace weft
