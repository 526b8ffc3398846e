// Slowly varying light, drawn at reduced size: openness of each point to its surroundings, and fractions of the first
// two lights. Openness has two sources: nearby surfaces in view (creases, contacts), and a map of the scene from
// straight above (soft shade under large objects).
#include "frame.glsl"
#include "lights.glsl"
#include "shadows.glsl"
#include "soft_light.glsl"
#include "bounced_light.glsl"
layout(binding = 4) uniform sampler2D normals_heat;
layout(binding = 8) uniform sampler2D distances_surfaces;
layout(binding = 9) uniform sampler2D small_distances;
layout(binding = 6) uniform sampler2D sky_map;  // depths of the highest and lowest surface, seen from above
layout(location = 0) out vec4 soft_light;

// Directions and radii of the taps. Any 5x5 texels contain each of the 25 values once, so that the mean over them in
// SoftBlur is free of noise on a continuous surface.
vec2 blur_jitter(vec2 texel) {
  texel = floor(texel);
  vec2 at = mod(texel + 2.0 * texel.yx, 5.0);
  return (5.0 * at + at.yx + 0.5) / 25.0;
}

// Scalable ambient obscurance (McGuire, Mara, Luebke 2012, Eq. 1): the mean elevation of neighbours above the tangent
// plane, nearly independent of the distance of the taps.
float nearby_openness(vec2 uv, vec3 p_view, vec3 n_view, vec2 jitter, bool wanted) {
  float radius = 0.2 * frame.sky.w;
  vec2 reach_uv = min(radius / (2.0 * frame.frustum.xy * -p_view.z), vec2(0.12));
  ivec2 last = textureSize(small_distances, 0) - 1;
  float sum = 0.0;
  vec2 direction = first_direction(jitter.x);
  int taps = wanted ? NEARBY_TAPS : 0;
  for (int k = 0; k < taps; ++k) {
    // Uniform along the radius, not over the disc: contacts a few millimetres wide get enough taps.
    vec2 tap_uv = uv + (float(k) + jitter.y) / float(NEARBY_TAPS) * direction * reach_uv;
    direction = next_direction(direction);
    // Use the centre of the pixel whose distance was stored: half a pixel off, a floor seen at an angle occludes
    // itself.
    ivec2 texel = clamp(ivec2(tap_uv * frame.viewport.xy) / REDUCTION, ivec2(0), last);
    tap_uv = (vec2(small_to_full(texel)) + 0.5) * frame.viewport.zw;
    vec3 v = position_view(tap_uv, texelFetch(small_distances, texel, 0).r) - p_view;
    float d_sq = dot(v, v), fall = max(1.0 - d_sq / (radius * radius), 0.0);
    sum += fall * max(dot(v, n_view) + 4e-4 * p_view.z, 0.0) * inversesqrt(d_sq + 1e-8);
  }
  return clamp(1.0 - 2.1 * sum / float(NEARBY_TAPS), 0.0, 1.0);
}

// Fraction of the sky that remains visible. Surfaces in the map above the point act as horizontal patches: one of area
// A at height h and distance d covers its form factor, A cos_receiver (h / d) / (pi d^2).
float sky_openness(vec3 p_world, vec3 n_world, float turn, bool wanted) {
  float reach = frame.sky.w, depth_metres = frame.ground.w;
  vec3 up = frame.up_world.xyz, across = frame.right_world.xyz, along = cross(up, across);
  vec3 above = (frame.above_from_world * vec4(p_world, 1.0)).xyz;
  mat2 above_axes = mat2((mat3(frame.above_from_world) * across).xy, (mat3(frame.above_from_world) * along).xy);
  // A texel represents its whole width: on a slope its height is inexact, and the slope must not occlude itself.
  float texel_metres = 1.0 / (float(textureSize(sky_map, 0).x) * length(above_axes[0]));
  float slack = texel_metres * length(n_world - dot(n_world, up) * up), covered = 0.0;
  vec2 direction = first_direction(turn);
  int taps = wanted ? SKY_TAPS : 0;
  for (int k = 0; k < taps; ++k) {
    // Radius r = reach t^2 for t = (k + 1/2) / n, denser towards the zenith; this gives the patch area 2 pi r dr = ring
    // dt. In the denominator, a ninth of the ring limits the contribution of very near patches, whatever the number of
    // taps.
    float t = (float(k) + 0.5) / float(SKY_TAPS), r = reach * t * t;
    vec2 offset = direction * r;
    direction = next_direction(direction);
    float ring = 12.5663706 * reach * r * t;
    // Depth 1 means no caster: points below the map's range, such as a floor under a falling band, are not covered.
    vec2 depths = textureLod(sky_map, above.xy + above_axes * offset, 0.0).rg;
    vec2 heights = (above.z - depths) * depth_metres;
    float covers = float(depths.x < 1.0 && heights.x > 2e-3);
    float height = heights.y > 2e-3 ? heights.y : heights.x;
    vec3 w = across * offset.x + along * offset.y + up * height;
    float d_sq = dot(w, w);
    covered += covers * ring * max(dot(n_world, w) - slack, 0.0) * height / (d_sq * (3.14159265 * d_sq + ring / 9.0));
  }
  return clamp(1.0 - covered / float(SKY_TAPS), 0.0, 1.0);
}

float share(int i, vec3 p_world, vec3 n_world, float rise, bool solid, float surface) {
  float cone;
  vec3 l = toward_light(i, p_world, cone);
  bool wanted = surface != kNothing && cone > 0.0;
  ShadowPoint at = shadow_point(p_world, n_world, l, rise, solid);
  return visibility(i, at.position_world, at.normal_world, wanted);
}

void main() {
  ivec2 pixel = small_to_full(ivec2(gl_FragCoord.xy));
  vec2 uv = (vec2(pixel) + 0.5) * frame.viewport.zw;
  pixel = min(pixel, ivec2(frame.viewport.xy) - 1);
  vec2 seen = texelFetch(distances_surfaces, pixel, 0).rg;
  float distance_view = seen.x, surface = floor(seen.y);
  vec3 n_world = frame.floor_plane_world.xyz;
  float rise = 0.0;
  bool solid = false;
  if (surface >= kFirstSurface) {
    vec4 normal_heat = texelFetch(normals_heat, pixel, 0);
    n_world = normalize(normal_heat.xyz);
    rise = length(normal_heat.xyz) - 1.0;
    solid = normal_heat.w < 0.5 * kSolid;
  }
  vec3 p_view = position_view(uv, distance_view), p_world = world_from_view(p_view) + frame.eye_world.xyz;
  vec2 jitter = blur_jitter(gl_FragCoord.xy);
  // Far from all subjects nothing is occluded.
  vec3 away = p_world - frame.center_world.xyz;
  float beyond = frame.eye_world.w + frame.sky.w;
  float hidden = 1.0 - smoothstep(0.6, 1.0, dot(away, away) / (beyond * beyond));
  bool near = surface != kNothing && hidden > 0.0;
  float open = nearby_openness(uv, p_view, mat3(frame.view_from_world) * n_world, jitter, near);
  open *= sky_openness(p_world, n_world, jitter.x, near);
  // Fade out, so that the limit of the search shows no edge.
  open = mix(1.0, open, hidden);
  // Floor that may receive bounced light counts as shaded.
  if (in_bounced_light(p_world)) open = min(open, 0.9975);
  vec2 lit = vec2(share(0, p_world, n_world, rise, solid, surface), 1.0);
#if LIGHTS > 1
  lit.y = share(1, p_world, n_world, rise, solid, surface);
#endif
  soft_light = vec4(pack_soft(surface, surface == kNothing ? 1.0 : open), lit, distance_view);
}
