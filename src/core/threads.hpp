// How the threads of a cloth lie, as it is drawn.
#pragma once

namespace weft {

/// In the order of shaders/weave.glsl. `denim`: a twill whose weft is undyed. `none`: pressed fibres, or hide.
enum class Threads { plain, twill, denim, knit, none };

}  // namespace weft
