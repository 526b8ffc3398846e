// Backdrop behind all surfaces. It varies slowly, so its colour is computed only at the corners of a grid.
#include "shading.glsl"
#include "stage.glsl"
layout(location = 0) in vec2 corner_clip;
noperspective out vec3 shown;
void main() {
  shown = encode(backdrop_color(world_from_view(normalize(position_view(0.5 * corner_clip + 0.5, 1.0)))));
  gl_Position = vec4(corner_clip, 0.0, 1.0);
}
