// Open floor, if its light varies so slowly over the picture that the corners of a grid suffice (Shading::Programs).
#include "shading.glsl"
#include "open_floor.glsl"
layout(location = 0) in vec2 corner_clip;
noperspective out vec3 shown;
void main() {
  vec3 ray_world = world_from_view(position_view(0.5 * corner_clip + 0.5, 1.0));
  shown = encode(open_floor(frame.floor_look.rgb, ray_world));
  gl_Position = vec4(corner_clip, 0.0, 1.0);
}
