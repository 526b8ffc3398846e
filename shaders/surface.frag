// Cloth and solid surfaces: direct light with soft shadows, ambient light, and the sheen or gloss of the material.
#include "shading.glsl"
#include "highlight.glsl"
#include "traced_light.glsl"
#ifdef CLOTH
#include "weave.glsl"
#ifdef TRIMMED
#include "trim.glsl"
#endif
#endif
layout(binding = 4) uniform sampler2D normals_heat;
layout(binding = 5) uniform sampler2D rest_uvs;
layout(binding = 8) uniform sampler2D distances_surfaces;
// One row per surface. Columns:
// 0: front colour; roughness. 1: back colour; thread spacing [m].
// 2: heat scale, width of hem [m], thickness [m], distance of stitches from seams [m].
// 3: cloth: gloss, warp fraction, fuzz, sheer; other surfaces: coat, metal.
// 4: opacity, threads, 1 for skin.
layout(binding = 7) uniform sampler2D materials;
layout(binding = 6) uniform sampler2D heat_colors;
#ifdef PAINTED
layout(binding = 10) uniform sampler2D paints;  // output `paint` of geometry.frag
#endif
layout(location = 0) out vec4 color;

#ifdef CLOTH
// Highlight of threads, wide across the threads and narrow along them, because the facets lie around the thread
// (anisotropic GGX, Burley, "Physically-Based Shading at Disney", 2012). t: along the threads; b: across.
float thread_highlight(vec3 n, vec3 t, vec3 b, vec3 v, vec3 l) {
  const float kAlong = 0.22, kAcross = 0.62;
  vec3 h = normalize(v + l);
  float h_t = dot(h, t) / kAlong, h_b = dot(h, b) / kAcross, h_n = dot(h, n), d = h_t * h_t + h_b * h_b + h_n * h_n;
  float n_l = max(dot(n, l), 0.0), n_v = max(dot(n, v), 0.05);
  d = max(d, 1.0);  // d >= 1 if t, b and n are orthogonal; at outlines, derivatives make them non-orthogonal
  return n_l / (kAlong * kAcross * d * d * 4.0 * (n_l + n_v - n_l * n_v));
}
#endif

// Surface data for add_light(). n: normal; n_smooth: normal without threads, hems and seams; v: unit vector to the eye;
// shine: factor on the highlight; alpha: roughness squared; f0: reflectance at normal incidence.
struct Point {
  vec3 position_world, n, n_smooth, v;
  float shine, alpha, f0;
  vec3 weft, warp;   // unit vectors in the surface
  vec4 finish;       // cloth: column 3 of `materials`; METAL: x: coat, y: metal fraction
#ifdef METAL
  vec3 colored_f0;
#endif
#ifdef SKIN
  float skin;
#endif
};
// Sums over the lights. through: light that reaches the other side of cloth; gloss: highlights.
struct LightSums {
  vec3 diffuse, through, gloss;
};
const float kThreadShine = 0.14;  // reflectance factor of threads with full gloss
#ifdef SKIN
// Inside skin, red light travels farthest, so that skin is redder near the terminator and in penumbrae. The values are
// tuned by eye, from profiles of Jensen et al., "A Practical Model for Subsurface Light Transport", 2001.
const vec3 kScattered = vec3(0.50, 0.17, 0.06);
const vec3 kPastTerminator = vec3(0.20, 0.11, 0.07);  // light emerges down to this cosine of normal and light, negated
vec3 scattered(float lit, float skin) { return mix(vec3(lit), vec3(lit * (2.0 - lit)), skin * kScattered); }
// The clamped cosine max(cosine, 0), rounded at the terminator.
vec3 scattered_cosine(float cosine, float skin) {
  vec3 width = skin * kPastTerminator, rounded = clamp(cosine + width, vec3(0.0), 2.0 * width);
  return rounded * rounded / max(4.0 * width, 1e-4) + max(cosine - width, 0.0);
}
#endif
const float kCoat = 0.04, kCoatAlpha = 0.02;  // clear coat (glass): reflectance at normal incidence; roughness squared

void add_light(inout LightSums sums, int i, Point at, float lit) {
  float cone;
  vec3 l = toward_light(i, at.position_world, cone);
  float side = dot(at.n_smooth, l);
  vec3 strength = lights[i].color.rgb * (cone * lit);
#ifdef SKIN
  sums.diffuse += lights[i].color.rgb * cone * scattered(lit, at.skin) * scattered_cosine(side, at.skin);
#else
  sums.diffuse += strength * (max(dot(at.n, l), 0.0) * smoothstep(0.0, 0.06, side));
#endif
#ifdef CLOTH
  // Light that hits the other side of the cloth passes between the threads.
  sums.through += strength * max(-side, 0.0);
  float shine = highlight(at.n, at.v, l, max(at.alpha, 0.2), at.f0);
#ifdef GLOSSY
  shine += kThreadShine * at.finish.x * mix(thread_highlight(at.n, at.weft, at.warp, at.v, l),
                                            thread_highlight(at.n, at.warp, at.weft, at.v, l), at.finish.y);
#endif
  sums.gloss += strength * (at.shine * step(0.0, side) * shine);
#elif defined(METAL)
  vec3 shine = colored_highlight(at.n, at.v, l, at.alpha, at.colored_f0);
  shine = mix(shine, vec3(0.0), at.finish.x * kCoat) + at.finish.x * highlight(at.n, at.v, l, kCoatAlpha, kCoat);
  sums.gloss += strength * (shine * smoothstep(0.0, 0.06, side));
#else
  sums.gloss += strength * (highlight(at.n, at.v, l, at.alpha, at.f0) * smoothstep(0.0, 0.06, side));
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 seen = texelFetch(distances_surfaces, pixel, 0).rg;
  float distance_view = seen.x, surface = floor(seen.y);
  vec4 normal_heat = texelFetch(normals_heat, pixel, 0);
  int row = int(surface - kFirstSurface);
  vec4 front_roughness = texelFetch(materials, ivec2(0, row), 0);
  vec4 back_spacing = texelFetch(materials, ivec2(1, row), 0);
  vec4 opacity_threads = texelFetch(materials, ivec2(4, row), 0);
  vec4 heat_trim = texelFetch(materials, ivec2(2, row), 0);
  float heat_scale = heat_trim.x;

  Point at;
  vec3 offset_world = world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, distance_view));
  at.position_world = offset_world + frame.eye_world.xyz;
  at.v = -normalize(offset_world);
  // Near outlines, the smooth normal may point away from the eye. The normal is then tilted until it is nearly
  // perpendicular to the view ray.
  vec3 n_seen = normalize(normal_heat.xyz);
  at.n = at.n_smooth = normalize(n_seen + at.v * max(0.02 - dot(n_seen, at.v), 0.0));
  float roughness = front_roughness.w;
  at.alpha = max(roughness * roughness, 0.02);
  at.f0 = head_on(roughness);
  at.shine = 1.0;
#ifdef SKIN
  at.skin = 0.0;
#endif
  vec3 albedo = front_roughness.rgb;
#ifdef CLOTH
  bool front = seen.y - surface < 0.25;
  albedo = front ? front_roughness.rgb : back_spacing.rgb;
  vec3 behind = front ? back_spacing.rgb : front_roughness.rgb;
#endif
#ifdef PAINTED
  vec4 paint = texelFetch(paints, pixel, 0);
  if (paint.w > 0.5) {
    albedo = paint.rgb * paint.rgb;
#ifdef SKIN
    // Only pixels with a colour that skin can have are shaded as skin. Pixels that a picture covers, such as hair and
    // shoes, are glossier.
    float bare = opacity_threads.z * clamp(2.5 * (1.0 - paint.w), 0.0, 1.0);
    at.skin = bare * smoothstep(0.01, 0.12, albedo.r - albedo.b);
    at.alpha = mix(at.alpha, min(at.alpha, 0.18), opacity_threads.z - bare);
#endif
#ifdef CLOTH
    behind = albedo;
#endif
  }
#endif
#ifdef CLOTH
  at.finish = texelFetch(materials, ivec2(3, row), 0);
  at.finish.x *= at.finish.x * at.finish.x;  // cubed, because the highlights of cotton and satin differ much
  // Derivatives also read pixels beside cloth, where the texture may contain rest coordinates of an earlier picture.
  vec2 rest_uv = row < 0 ? vec2(0.0) : texelFetch(rest_uvs, pixel, 0).xy;
  int threads = int(opacity_threads.y);
  Weave woven = weave(rest_uv, row < 0 ? 0.0 : back_spacing.w, threads, at.finish.z, at.n, at.position_world);
  at.n = woven.normal_world;
  if (threads == kDenim) albedo = denim_color(albedo, front ? woven.weft : 1.0 - woven.weft);
  albedo *= woven.tone;
  at.shine = woven.shine;
#ifdef TRIMMED
  Trimmed trimmed = trim(pixel, distance_view * 2.0 * frame.frustum.y * frame.viewport.w, rest_uv, heat_trim.yzw, front, threads, woven, at.n);
  at.n = trimmed.normal_world;
  albedo = mix(albedo * trimmed.tone, kDenimThreadColor, trimmed.thread);
  if (trimmed.layers > 1.0) at.finish.w = mix(at.finish.w, at.finish.w * at.finish.w, trimmed.layers - 1.0);
#endif
  at.weft = normalize(woven.weft_world - dot(woven.weft_world, at.n) * at.n + 1e-6);
  at.warp = normalize(woven.warp_world - dot(woven.warp_world, at.n) * at.n + 1e-6);
#endif
#ifdef HEAT
  if (heat_scale > 0.0) {
    float hot = clamp(normal_heat.w * heat_scale, 0.0, 1.0);
    albedo = textureLod(heat_colors, vec2((hot * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
#ifdef CLOTH
    behind = albedo;
#endif
  }
#endif

#ifdef METAL
  at.finish = texelFetch(materials, ivec2(3, row), 0);
  at.colored_f0 = mix(vec3(at.f0), albedo, at.finish.y);
#endif

  vec4 lit = texelFetch(lamps_lit, pixel, 0), from_surfaces = texelFetch(surface_light, pixel, 0);
  float open = from_surfaces.w;
  // Near shaded floor, `from_surfaces` is negative. The lower bound is needed because it may subtract more than the
  // light of the surroundings.
  vec3 around_light = irradiance(at.n) * open;
  around_light = max(around_light + from_surfaces.rgb, 0.1 * around_light);
  LightSums light = LightSums(around_light, vec3(0.0), vec3(0.0));
  add_light(light, 0, at, lit.x);
#if LIGHTS > 1
  add_light(light, 1, at, lit.y);
#endif
#if LIGHTS > 2
  add_light(light, 2, at, lit.z);
#endif
#if LIGHTS > 3
  add_light(light, 3, at, lit.w);
#endif

  float edge = 1.0 - max(dot(at.n_smooth, at.v), 0.0), rim = edge * edge * edge * edge;
#ifdef CLOTH
  // Protruding fibres scatter light at grazing angles, which gives a soft sheen in a paler colour of the cloth.
  vec3 pale = mix(albedo, vec3(0.6), 0.35);
  vec3 sheen = pale * light.diffuse * (at.finish.z * edge * edge * edge);
  vec3 through = irradiance(-at.n_smooth) * open + light.through;
  vec3 around = vec3(0.0);
#ifdef GLOSSY
  // Surroundings reflected by the threads.
  around = surroundings(reflect(-at.v, at.n), 0.4) * (at.finish.x * open * (0.04 + 0.3 * rim));
#endif
  vec3 linear = albedo * (light.diffuse * (1.0 - 0.4 * max(at.finish.w - 0.3, 0.0)) + at.finish.w * behind * through) + sheen +
                light.gloss + around;
#elif defined(METAL)
  // Other surfaces in the mirrored direction cover the surroundings and add their own light; shaded floor subtracts
  // light.
  vec3 mirrored = reflect(-at.v, at.n);
  vec4 near_by = texelFetch(mirrored_surfaces, pixel, 0);
  // Only metal and coats have mirror rays; other surfaces use the uncovered fraction of all surroundings.
  float past = at.finish.x + at.finish.y > 0.0 ? 1.0 - near_by.w : open;
  vec3 reflectance = at.colored_f0 + (1.0 - at.colored_f0) * rim * (1.0 - roughness);
  vec3 around = surroundings(mirrored, at.alpha) * past, above = surroundings(mirrored, kCoatAlpha) * past;
  around = max(around + near_by.rgb, 0.1 * around);
  above = max(above + near_by.rgb, 0.1 * above);
  float coat = at.finish.x * (kCoat + (1.0 - kCoat) * rim * edge);
  vec3 base = albedo * light.diffuse * (1.0 - at.finish.y) * (1.0 - reflectance) + around * reflectance;
  vec3 linear = mix(base, above, coat) + light.gloss;
#else
#ifdef SKIN
  // Fine hairs of skin scatter light at grazing angles.
  light.diffuse *= 1.0 + 0.35 * at.skin * edge * edge * edge;
#endif
  float mirror = (at.f0 + (1.0 - at.f0) * rim * (1.0 - roughness)) * open;
  vec3 around = surroundings(reflect(-at.v, at.n), at.alpha);
  vec3 linear = albedo * light.diffuse * (1.0 - mirror) + around * mirror + light.gloss;
#endif
  float alpha = 1.0;
#ifdef SHEER
  // At oblique view, the path of light through the threads is longer.
  float layers = 1.0 / max(dot(at.n_smooth, at.v), 0.2);
#ifdef TRIMMED
  layers *= trimmed.layers;
#endif
  alpha = 1.0 - pow(1.0 - opacity_threads.x, layers);
#endif
  color = vec4(encode(linear), alpha);
}
