// Everything with triangles, floor included.
#include "frame.glsl"
layout(location = 0) in vec3 position_world;
layout(location = 1) in vec3 normal_world;
layout(location = 2) in vec2 vertex_uv;
layout(location = 3) in float heat;
out vec3 surface_normal_world;
out vec2 surface_uv;
out float surface_heat;
invariant gl_Position;
void main() {
  surface_normal_world = normal_world;
  surface_uv = vertex_uv;
  surface_heat = heat;
  gl_Position = frame.clip_from_world * vec4(position_world, 1.0);
}
