// Light from the sky, ambient occlusion, reflections and the way to the screen; used by all drawn surfaces.
#include "frame.glsl"
#include "lights.glsl"
layout(binding = 4) uniform sampler2D normals;
layout(binding = 5) uniform sampler2D uv_heat_materials;
layout(binding = 8) uniform sampler2D distances;
layout(binding = 7) uniform sampler2D materials;  // a row for each: front colour, roughness; back colour, thread spacing;
                                                  // heat scale, checker
layout(binding = 3) uniform sampler2D soft_light;  // openness, share of light 0, surface, distance; see soft_light.frag

struct Seen {
  vec3 position_world;
  vec3 normal_world;  // unit, toward the viewer
  float distance_view;
  vec2 rest_uv;
  float heat;
  bool front;
  float surface;  // row of its material
  vec4 front_roughness, back_spacing, heat_checker;  // of its material
};

Seen look_up_seen() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 other = texelFetch(uv_heat_materials, pixel, 0);
  int row = int(other.w);
  Seen seen;
  seen.distance_view = texelFetch(distances, pixel, 0).r;
  seen.position_world =
      world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, seen.distance_view)) + frame.eye_world.xyz;
  seen.normal_world = normalize(texelFetch(normals, pixel, 0).xyz);
  seen.rest_uv = other.xy;
  seen.heat = other.z;
  seen.surface = float(row);
  seen.front = other.w - float(row) < 0.25;
  seen.front_roughness = texelFetch(materials, ivec2(0, row), 0);
  seen.back_spacing = texelFetch(materials, ivec2(1, row), 0);
  seen.heat_checker = texelFetch(materials, ivec2(2, row), 0);
  return seen;
}

struct Softness {
  float open;        // share of the surroundings that light this point
  float first_lit;   // share of light 0 that reaches it
  bool first_known;  // false where the neighbours disagree, as along the edge of a crisp shadow
};

#ifdef SOFT_LIGHT
// Sums over texels of the small picture, each weighted by how surely it shows the surface seen.
struct SoftSums {
  float weight, open, lit, least, most;
};

void add_soft_texel(inout SoftSums sums, ivec2 at, float weight, Seen seen) {
  vec4 texel = texelFetch(soft_light, clamp(at, ivec2(0), textureSize(soft_light, 0) - 1), 0);
  float same = max(1.0 - abs(texel.w - seen.distance_view) / (0.02 * seen.distance_view), 0.0);
  // Where cloth lies on a floor both are as far away, but not in the same light.
  same *= float(texel.z == seen.surface);
  weight *= max(same, 1e-4);
  sums.weight += weight;
  sums.open += weight * texel.x;
  sums.lit += weight * texel.y;
  sums.least = min(sums.least, same > 0.0 ? texel.y : 1.0);
  sums.most = max(sums.most, same > 0.0 ? texel.y : 0.0);
}
#endif

// What the small picture knows of this pixel, from its neighbours there, as far as they lie on the same surface.
Softness look_up_softness(Seen seen) {
#ifdef SOFT_LIGHT
  vec2 at = gl_FragCoord.xy * frame.viewport.zw * vec2(textureSize(soft_light, 0)) - 0.5;
  ivec2 corner = ivec2(floor(at));
  vec2 f = at - floor(at);
  SoftSums sums = SoftSums(0.0, 0.0, 0.0, 1.0, 0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1);
    vec2 side = mix(1.0 - f, f, vec2(step));
    add_soft_texel(sums, corner + step, side.x * side.y + 0.01, seen);
  }
  // Where none of the four is of this surface, as beside a nearer thing, the four around them are asked as well.
  int more = sums.weight < 2e-3 ? 4 : 0;
  for (int i = 0; i < more; ++i) add_soft_texel(sums, corner + ivec2(i & 1, i >> 1) * 3 - 1, 0.1, seen);
  bool known = sums.most >= sums.least && sums.most - sums.least < 0.2;
  return Softness(sums.open / sums.weight, sums.lit / sums.weight, known);
#else
  return Softness(1.0, 1.0, false);
#endif
}

// Share of light i at a point, from the small picture where that knows it. The search at full size is left out of
// programs without FULL_SHADOWS, as llvmpipe would run a round of it for every pixel: 40 ns.
float share_of_light(int i, Softness soft, vec3 position_world, vec3 n_toward_light, bool wanted) {
#ifdef FULL_SHADOWS
  bool known = i == 0 && soft.first_known;
  float searched = visibility(i, position_world, n_toward_light, wanted && !known);
  return known ? soft.first_lit : searched;
#else
  return soft.first_lit;
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
