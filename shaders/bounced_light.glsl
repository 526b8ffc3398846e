// Light that surfaces and shaded floor reflect onto each other (bounced_light.hpp).
layout(std140, binding = 2) uniform BouncedLight {
  vec4 first_cell_world;  // its centre; w: cells per metre
  vec4 cells;             // number of cells along x, y, z
} bounced;
layout(binding = 15) uniform sampler3D bounced_light_map;  // for normals +x, -x, +y, -y, +z, -z, stacked along z

// Light on matte white with normal `n`, and the hidden fraction of its surroundings; sides weighted by the squared
// components of n (McTaggart, "Half-Life 2 / Valve Source Shading", 2004). LEVEL: the normal is an axis, so one lookup
// suffices; each costs llvmpipe 13 ns per pixel.
vec4 bounced_light(vec3 position_world, vec3 n) {
  // Slightly in front, so that cells behind the surface have less weight.
  vec3 at = (position_world - bounced.first_cell_world.xyz) * bounced.first_cell_world.w + 0.4 * n;
  at = (clamp(at, vec3(0.0), bounced.cells.xyz - 1.0) + 0.5) / bounced.cells.xyz;
  vec3 share = n * n, slab = (vec3(0.0, 2.0, 4.0) + step(n, vec3(0.0)) + at.z) / 6.0;
#ifdef LEVEL
  return texture(bounced_light_map, vec3(at.xy, dot(share, slab)));
#else
  return share.x * texture(bounced_light_map, vec3(at.xy, slab.x)) +
         share.y * texture(bounced_light_map, vec3(at.xy, slab.y)) +
         share.z * texture(bounced_light_map, vec3(at.xy, slab.z));
#endif
}
// Upper bound of openness from the hidden fraction. The grid includes folds that do not occlude this point and counts
// each layer separately: a third is ignored, and the result is at least 0.5.
float open_at_most(float hidden) { return 1.0 - 0.5 * clamp(1.5 * hidden - 0.5, 0.0, 1.0); }
// Whether a point is inside the grid, where bounced light may reach it.
bool in_bounced_light(vec3 position_world) {
  vec3 at = (position_world - bounced.first_cell_world.xyz) * bounced.first_cell_world.w;
  return all(greaterThan(at, vec3(0.0))) && all(lessThan(at, bounced.cells.xyz - 1.0));
}
