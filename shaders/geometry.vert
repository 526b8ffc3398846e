// Depth and normals at reduced size, for ambient occlusion.
#include "frame.glsl"
layout(location = 0) in vec3 position_world;
layout(location = 1) in vec3 normal_world;
out vec3 surface_normal_world;
void main() {
  surface_normal_world = normal_world;
  gl_Position = frame.clip_from_world * vec4(position_world, 1.0);
}
