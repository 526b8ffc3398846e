// Open floor under suns varies so slowly over the picture that it is computed at the corners of a grid.
#include "shading.glsl"
#include "open_floor.glsl"
layout(location = 0) in vec2 corner_clip;
noperspective out vec3 shown;
void main() {
  vec3 ray_world = world_from_view(position_view(0.5 * corner_clip + 0.5, 1.0));
  shown = encode(open_floor(frame.floor_look.rgb, ray_world));
  gl_Position = vec4(corner_clip, 0.0, 1.0);
}
