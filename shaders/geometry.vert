// Vertices of all triangle meshes, including the floor.
#include "frame.glsl"
layout(location = 0) in vec3 position_world;
layout(location = 1) in vec3 normal_world;
layout(location = 2) in vec2 vertex_uv;
layout(location = 3) in float heat;
#ifdef PICTURED
layout(location = 4) in vec2 vertex_place;
uniform vec3 picture_u, picture_v;  // rows of the map to picture coordinates
out vec2 place;
#endif
#ifdef TRIMMED
layout(location = 5) in vec3 vertex_trim_distances;
layout(location = 6) in vec3 vertex_trim_places;
out vec3 trim_distances, trim_places;
#endif
uniform float depth_offset;  // depth offset towards the viewer [m]
out vec3 surface_normal_world;
out vec2 surface_uv;
out float surface_heat;
// For rise() in geometry.frag: squares of the components of the normal n, their products, and n times dot(n, p), where
// p is the position relative to the eye.
out vec3 normal_squares, normal_products, plane;
invariant gl_Position;
#ifdef CLIPPED
out float gl_ClipDistance[1];  // height above the floor [m], for mirror.hpp
#endif
void main() {
  surface_normal_world = normal_world;
  surface_uv = vertex_uv;
  surface_heat = heat;
  normal_squares = normal_world * normal_world;
  normal_products = normal_world.yzx * normal_world.zxy;
  plane = normal_world * dot(normal_world, position_world - frame.eye_world.xyz);
#ifdef PICTURED
  place = vec2(dot(picture_u, vec3(vertex_place, 1.0)), dot(picture_v, vec3(vertex_place, 1.0)));
#endif
#ifdef TRIMMED
  trim_distances = vertex_trim_distances;
  trim_places = vertex_trim_places;
#endif
#ifdef CLIPPED
  // Rounding must not remove surfaces that lie on the floor, thus the added 1 mm.
  gl_ClipDistance[0] =
      dot(frame.floor_plane_world.xyz, position_world - frame.eye_world.xyz) + frame.floor_plane_world.w + 1e-3;
#endif
  gl_Position = frame.clip_from_world * vec4(position_world, 1.0);
  if (depth_offset > 0.0 && gl_Position.w > frame.frustum.z) {
    float near = frame.frustum.z;
    gl_Position.z = near * gl_Position.w / max(gl_Position.w - depth_offset, near);
  }
}
