// Arrangement of the threads of a cloth, for drawing.
#pragma once

namespace weft {

/// Pattern of the threads. The order is that of the numbers in shaders/weave.glsl. `denim`: a twill with undyed weft.
/// `none`: no threads, as in felt or leather.
enum class Threads { plain, twill, denim, knit, none };

}  // namespace weft
