// What the small picture of soft light says of a pixel; after shading.glsl, in fragment shaders.
#include "shadows.glsl"
#include "soft_light.glsl"
layout(binding = 3) uniform sampler2D soft_light;  // soft_light.frag

struct Softness {
  float open;   // share of the surroundings that light this point
  vec2 lit;     // shares of the first two lights that reach it
  bvec2 known;  // false along the edges of crisp shadows, and where no neighbour is of this surface
};
const Softness kAllOpen = Softness(1.0, vec2(1.0), bvec2(true));

// Sums over texels of the small picture, each weighted by how surely it shows the surface seen.
struct SoftSums {
  float weight, open;
  vec2 lit, crisp;
};

void add_soft_texel(inout SoftSums sums, ivec2 at, float weight, float distance_view, float surface) {
  vec4 texel = texelFetch(soft_light, clamp(at, ivec2(0), textureSize(soft_light, 0) - 1), 0);
  float same = max(1.0 - abs(texel.w - distance_view) / (0.02 * distance_view), 0.0);
  // Where cloth lies on a floor both are as far away, but not in the same light.
  same *= float(soft_surface(texel) == surface);
  weight *= max(same, 1e-4);
  sums.weight += weight;
  sums.open += weight * soft_open(texel);
  sums.lit += weight * soft_lit(texel);
  if (same > 0.0) sums.crisp = max(sums.crisp, soft_crisp(texel));
}

// What the small picture knows of this pixel, from its neighbours there, as far as they lie on the same surface.
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
  // Where none of the four is of this surface, as beside a nearer thing, the four around them are asked as well.
  int more = sums.weight < 2e-3 ? 4 : 0;
  for (int i = 0; i < more; ++i) {
    add_soft_texel(sums, corner + ivec2(i & 1, i >> 1) * 3 - 1, 0.1, distance_view, surface);
  }
  bool any_same = sums.weight >= 2e-3;
  bvec2 known = bvec2(any_same && sums.crisp.x == 0.0, any_same && sums.crisp.y == 0.0);
  return Softness(sums.open / sums.weight, sums.lit / sums.weight, known);
}

// Share of light i at a point, from the small picture where that knows it. The search at full size is left out of
// programs without FULL_SHADOWS, as llvmpipe would run a round of it for every pixel: 40 ns.
float share_of_light(int i, Softness soft, ShadowPoint at, bool wanted) {
#ifdef FULL_SHADOWS
  bool known = i < 2 && soft.known[min(i, 1)];
  float searched = visibility(i, at.position_world, at.normal_world, wanted && !known);
  return known ? soft.lit[min(i, 1)] : searched;
#else
  return soft.lit[min(i, 1)];
#endif
}
