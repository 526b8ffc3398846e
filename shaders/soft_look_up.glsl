// Lookup of a pixel in the soft light buffer; include after shading.glsl, in fragment shaders.
#include "shadows.glsl"
#include "soft_light.glsl"
layout(binding = 3) uniform sampler2D soft_light;  // soft_light.frag

struct Softness {
  float open;   // fraction of the surroundings that light this point
  vec2 lit;     // fractions of the first two lights that reach it
  bvec2 known;  // false along sharp shadow edges, and if no neighbour has this surface
};
const Softness kAllOpen = Softness(1.0, vec2(1.0), bvec2(true));

// Sums over texels, weighted by how well each matches the pixel's surface.
struct SoftSums {
  float weight, open;
  vec2 lit, crisp;
};

void add_soft_texel(inout SoftSums sums, ivec2 at, float weight, float distance_view, float surface) {
  vec4 texel = texelFetch(soft_light, clamp(at, ivec2(0), textureSize(soft_light, 0) - 1), 0);
  float same = max(1.0 - abs(texel.w - distance_view) / (0.02 * distance_view), 0.0);
  // Cloth on a floor has the same distance, but not the same light.
  same *= float(soft_surface(texel) == surface);
  weight *= max(same, 1e-4);
  sums.weight += weight;
  sums.open += weight * soft_open(texel);
  sums.lit += weight * soft_lit(texel);
  if (same > 0.0) sums.crisp = max(sums.crisp, soft_crisp(texel));
}

// Interpolates the soft light buffer at this pixel from the texels of the same surface.
Softness look_up_softness(float distance_view, float surface) {
  vec2 at = full_to_small(gl_FragCoord.xy);
  ivec2 corner = ivec2(floor(at));
  vec2 f = at - floor(at);
  SoftSums sums = SoftSums(0.0, 0.0, vec2(0.0), vec2(0.0));
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    vec2 side = mix(1.0 - f, f, vec2(step));
    add_soft_texel(sums, corner + step, side.x * side.y + 0.01, distance_view, surface);
  }
  // If none of the four texels has this surface, as beside a nearer object, also sample the four diagonal ones around
  // them.
  int more = sums.weight < 2e-3 ? 4 : 0;
  for (int i = 0; i < more; ++i) {
    add_soft_texel(sums, corner + ivec2(i & 1, i >> 1) * 3 - 1, 0.1, distance_view, surface);
  }
  bool any_same = sums.weight >= 2e-3;
  bvec2 known = bvec2(any_same && sums.crisp.x == 0.0, any_same && sums.crisp.y == 0.0);
  return Softness(sums.open / sums.weight, sums.lit / sums.weight, known);
}

// Fraction of light i at a point, from the soft light buffer if known there. Programs without FULL_SHADOWS omit the
// search at full size, because llvmpipe would execute one iteration for every pixel: 40 ns.
float share_of_light(int i, Softness soft, ShadowPoint at, bool wanted) {
#ifdef FULL_SHADOWS
  bool known = i < 2 && soft.known[min(i, 1)];
  float searched = visibility(i, at.position_world, at.normal_world, wanted && !known);
  return known ? soft.lit[min(i, 1)] : searched;
#else
  return soft.lit[min(i, 1)];
#endif
}
