// Light from the sky, ambient occlusion, reflections and the way to the screen; used by all drawn surfaces.
#include "frame.glsl"
#include "lights.glsl"
#include "soft_light.glsl"
layout(binding = 4) uniform sampler2D normals_heat;
layout(binding = 5) uniform sampler2D rest_uvs;
layout(binding = 8) uniform sampler2D distances_surfaces;
layout(binding = 7) uniform sampler2D materials;  // a row for each surface: front colour, roughness; back colour, thread
                                                  // spacing; heat scale
layout(binding = 3) uniform sampler2D soft_light;  // soft_light.frag

struct Softness {
  float open;   // share of the surroundings that light this point
  vec2 lit;     // shares of the first two lights that reach it
  bvec2 known;  // false where the neighbours disagree, as along the edge of a crisp shadow
};
const Softness kAllOpen = Softness(1.0, vec2(1.0), bvec2(true));

// Sums over texels of the small picture, each weighted by how surely it shows the surface seen.
struct SoftSums {
  float weight, open;
  vec2 lit, least, most;
};

void add_soft_texel(inout SoftSums sums, ivec2 at, float weight, float distance_view, float surface) {
  vec4 texel = texelFetch(soft_light, clamp(at, ivec2(0), textureSize(soft_light, 0) - 1), 0);
  float same = max(1.0 - abs(texel.w - distance_view) / (0.02 * distance_view), 0.0);
  // Where cloth lies on a floor both are as far away, but not in the same light.
  same *= float(soft_surface(texel) == surface);
  weight *= max(same, 1e-4);
  sums.weight += weight;
  sums.open += weight * soft_open(texel);
  sums.lit += weight * texel.yz;
  sums.least = min(sums.least, same > 0.0 ? texel.yz : vec2(1.0));
  sums.most = max(sums.most, same > 0.0 ? texel.yz : vec2(0.0));
}

// What the small picture knows of this pixel, from its neighbours there, as far as they lie on the same surface.
Softness look_up_softness(float distance_view, float surface) {
  vec2 at = gl_FragCoord.xy * frame.viewport.zw * vec2(textureSize(soft_light, 0)) - 0.5;
  ivec2 corner = ivec2(floor(at));
  vec2 f = at - floor(at);
  SoftSums sums = SoftSums(0.0, 0.0, vec2(0.0), vec2(1.0), vec2(0.0));
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
  vec2 spread = sums.most - sums.least;
  bvec2 known = bvec2(spread.x >= 0.0 && spread.x < 0.2, spread.y >= 0.0 && spread.y < 0.2);
  return Softness(sums.open / sums.weight, sums.lit / sums.weight, known);
}

// Share of light i at a point, from the small picture where that knows it. The search at full size is left out of
// programs without FULL_SHADOWS, as llvmpipe would run a round of it for every pixel: 40 ns.
float share_of_light(int i, Softness soft, vec3 position_world, vec3 n_toward_light, bool wanted) {
#ifdef FULL_SHADOWS
  bool known = i < 2 && soft.known[min(i, 1)];
  float searched = visibility(i, position_world, n_toward_light, wanted && !known);
  return known ? soft.lit[min(i, 1)] : searched;
#else
  return soft.lit[min(i, 1)];
#endif
}

// Light that a matte white surface takes from its surroundings: the sky above, the ground below, a little more from the
// camera's left, as a big window would give, so that shadowed folds keep their relief.
vec3 ambient_light(vec3 n_world, float open) {
  float upward = 0.5 + 0.5 * dot(n_world, frame.up_world.xyz);
  vec3 light = mix(frame.ground_light.rgb, frame.sky_light.rgb, upward);
  light *= 1.0 - 0.18 * dot(n_world, frame.right_world.xyz) * (1.0 - abs(2.0 * upward - 1.0));
  return light * open;
}

// Linear light to the sRGB bytes of the picture. Below 0.8 nothing changes; brighter light is bent towards 1 by its
// strongest channel, all channels alike, so that no hue shifts.
vec3 display(vec3 linear) {
  float peak = max(max(linear.r, linear.g), linear.b);
  if (peak > 0.8) linear *= (1.0 - 0.2 * exp((0.8 - peak) * 5.0)) / peak;
  // The curve of IEC 61966-2-1 by roots, fitted to within 0.1/255 on [0.0031, 1]: three powers cost 25 ns a pixel more.
  vec3 root = sqrt(linear);
  vec3 curve = 0.833761273 * root + 0.298103297 * sqrt(root) - 0.055321666 * linear - 0.076902919;
  vec3 encoded = mix(12.92 * linear, curve, greaterThan(linear, vec3(0.0031308)));
  // Half a level of noise keeps wide gradients from showing their steps.
  return encoded + (pixel_noise(gl_FragCoord.yx) - 0.5) / 255.0;
}
