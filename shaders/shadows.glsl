// Shadows; include after lights.glsl. A coarse map of depth ranges excludes pixels without nearby casters; only in and
// around penumbrae does a pixel search for blockers and filter (Fernando, "Percentage-Closer Soft Shadows", 2005).
layout(binding = 0) uniform sampler2DArrayShadow shadow_compare;
layout(binding = 1) uniform sampler2DArray shadow_depth;
layout(binding = 2) uniform sampler2DArray shadow_range;

// Fraction of light i that reaches a point, 0 to 1. `normal_world` faces the light. If not `wanted`, 1 without any
// search.
float visibility(int i, vec3 position_world, vec3 normal_world, bool wanted) {
  vec4 homogeneous = lights[i].shadow_from_world * vec4(position_world, 1.0);
  vec3 at = homogeneous.xyz / homogeneous.w;

  // The tangent plane as depth over texture coordinates, so that wide filters do not make a slope shadow itself.
  vec4 plane = lights[i].shadow_planes_from_world * vec4(normal_world, -dot(normal_world, position_world));
  float texel = 1.0 / SHADOW_TEXELS, bias = lights[i].shadow.z;
  vec2 slope = -plane.xy / (sign(plane.z) * max(abs(plane.z), 1e-6));
  // Nearly edge-on slopes would leave the map; there the light is faint anyway.
  slope *= min(1.0, MAX_SLOPE_TEXELS * bias / (texel * max(length(slope), 1e-9)));

  // llvmpipe executes both sides of every branch and leaves a loop only when all its pixels are done: optional work is
  // a loop with zero iterations, with a count that the compiler cannot know and unroll.
  vec2 range = texture(shadow_range, vec3(at.xy, i)).rg;
  vec2 reach = lights[i].shadow.xy * max(at.z - range.x, 0.0);
  reach = clamp(reach, vec2(FILTER_FLOOR_TEXELS * texel), vec2(FILTER_LIMIT_TEXELS * texel));
  // Depth range of the tangent plane over the filter.
  float lift = dot(abs(slope), reach + texel);
  bool outside = homogeneous.w <= 0.0 || any(greaterThan(abs(at.xy - 0.5), vec2(0.5)));
  bool all_lit = !wanted || outside || range.x == 1.0 || at.z + lift - bias <= range.x;
  bool all_dark = at.z - lift - bias > range.y;

  vec2 direction = first_direction(pixel_noise(gl_FragCoord.xy));
  float margin = bias + texel * length(slope), blocker_sum = 0.0, blocker_count = 0.0;
  int searches = all_lit || all_dark ? 0 : BLOCKER_TAPS;
  for (int k = 0; k < searches; ++k) {
    vec2 offset = sqrt((float(k) + 0.5) / float(BLOCKER_TAPS)) * direction * reach;
    direction = next_direction(direction);
    float depth = textureLod(shadow_depth, vec3(at.xy + offset, i), 0.0).r;
    // Depth 1 means no caster, also for points beyond the map's far plane.
    float blocks = float(depth < min(at.z + dot(slope, offset) - margin, 1.0));
    blocker_sum += depth * blocks;
    blocker_count += blocks;
  }
  vec2 radius = lights[i].shadow.xy * max(at.z - blocker_sum / max(blocker_count, 1.0), 0.0);
  radius = clamp(radius, vec2(FILTER_FLOOR_TEXELS * texel), reach);
  float lit = 0.0;
  int taps = blocker_count > 0.0 ? FILTER_TAPS : 0;
  for (int k = 0; k < taps; ++k) {
    vec2 offset = sqrt((float(k) + 0.5) / float(FILTER_TAPS)) * direction * radius;
    direction = next_direction(direction);
    float expected = min(at.z + dot(slope, offset) - bias - 0.5 * texel * length(slope), 1.0);
    lit += texture(shadow_compare, vec4(at.xy + offset, i, expected));
  }
  if (all_dark && !all_lit) return 0.0;
  return taps == 0 ? 1.0 : lit / float(FILTER_TAPS);
}

// A point whose visibility is asked for, and its normal facing the light.
struct ShadowPoint {
  vec3 position_world, normal_world;
};

// Shadow point of a surface lit from `l`. The point moves out to the smooth surface, `rise` metres outside its
// triangle: otherwise triangles shadow each other in a sawtooth at grazing light. There, solid bodies also ignore
// casters along `kThrough` metres: the map would show its own texels along the terminator.
ShadowPoint shadow_point(vec3 position_world, vec3 n_world, vec3 l, float rise, bool solid) {
  const float kThrough = 0.025, kGrazing = 0.1;
  float side = dot(n_world, l);
  vec3 n_toward = side < 0.0 ? -n_world : n_world;
  vec3 offset = max(side < 0.0 ? -rise : rise, 0.0) * n_toward;
  if (solid) offset += kThrough * clamp(1.0 - side / kGrazing, 0.0, 1.0) * l;
  return ShadowPoint(position_world + offset, n_toward);
}
