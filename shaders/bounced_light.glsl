// Light that surfaces and shaded floor send to each other (bounced_light.hpp).
layout(std140, binding = 2) uniform BouncedLight {
  vec4 first_cell_world;  // its middle; w: cells for each metre
  vec4 cells;             // how many there are along x, y, z
} bounced;
layout(binding = 15) uniform sampler3D bounced_light_map;  // what faces +x, -x, +y, -y, +z, -z, one above the other

// What matte white at a point takes that faces `n`, and how much of its surroundings is hidden: as its squared parts
// along the axes (McTaggart, "Half-Life 2 / Valve Source Shading", 2004). LEVEL: one axis has all of it; each look-up takes
// llvmpipe 13 ns a pixel.
vec4 bounced_light(vec3 position_world, vec3 n) {
  // A little in front, so that cells behind the surface count less.
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
// Openness at most, of that. Cubes also know of folds that hide nothing from a point, and count layers one by one: a third is
// let off, and nothing gets quite dark.
float open_at_most(float hidden) { return 1.0 - 0.5 * clamp(1.5 * hidden - 0.5, 0.0, 1.0); }
// What lies in these cells may be lit.
bool in_bounced_light(vec3 position_world) {
  vec3 at = (position_world - bounced.first_cell_world.xyz) * bounced.first_cell_world.w;
  return all(greaterThan(at, vec3(0.0))) && all(lessThan(at, bounced.cells.xyz - 1.0));
}
