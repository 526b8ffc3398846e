// Cloth and solid surfaces: direct light with soft shadows, light of the sky, and the sheen or gloss of the material.
#include "shading.glsl"
#ifdef CLOTH
#include "weave.glsl"
#endif
in vec3 surface_world;
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
uniform vec3 front_color;  // linear
uniform vec3 back_color;
uniform float roughness;
uniform float thread_spacing;  // [m], 0: none
uniform float heat_scale;      // 1 / hottest value; 0: no heat
layout(binding = 4) uniform sampler2D heat_colors;
layout(location = 0) out vec4 color;

// Microfacet highlight (GGX, Walter et al. 2007; visibility term by Hammon 2017), for reflectance f0 head-on.
float highlight(vec3 n, vec3 v, vec3 l, float alpha, float f0) {
  vec3 h = normalize(v + l);
  float n_h = max(dot(n, h), 0.0), n_l = max(dot(n, l), 0.0), n_v = max(dot(n, v), 1e-3), l_h = max(dot(l, h), 0.0);
  float a_sq = alpha * alpha, d = n_h * n_h * (a_sq - 1.0) + 1.0;
  float fresnel = f0 + (1.0 - f0) * pow(1.0 - l_h, 5.0);
  return fresnel * a_sq / (d * d) * 0.25 / mix(2.0 * n_l * n_v, n_l + n_v, alpha) * 2.0 * n_l;
}

void main() {
  vec3 v = normalize(frame.eye_world.xyz - surface_world);
  vec3 n = normalize(surface_normal_world) * (gl_FrontFacing ? 1.0 : -1.0);
  // Near outlines a smooth normal may lean away from the eye; bend it back to the horizon.
  n = normalize(n + v * max(0.02 - dot(n, v), 0.0));
  vec3 albedo = gl_FrontFacing ? front_color : back_color;
  vec3 n_smooth = n;
#ifdef CLOTH
  vec3 behind = gl_FrontFacing ? back_color : front_color;
  float shine = 1.0;
  if (thread_spacing > 0.0) {
    Weave woven = weave(surface_uv, thread_spacing, n, surface_world);
    n = woven.normal_world;
    albedo *= woven.tone;
    shine = woven.shine;
  }
#endif
  if (heat_scale > 0.0) {
    albedo = textureLod(heat_colors, vec2(clamp(surface_heat * heat_scale, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5), 0.0).rgb;
#ifdef CLOTH
    behind = albedo;
#endif
  }

  vec2 open = openness();
  vec3 diffuse = ambient_light(n, open);
  vec3 through = vec3(0.0), gloss = vec3(0.0);
  float alpha = max(roughness * roughness, 0.02), f0 = 0.04 * (1.0 - 0.9 * roughness * roughness);
  for (int i = 0; i < light_count.x; ++i) {
    float cone;
    vec3 l = toward_light(i, surface_world, cone);
    float side = dot(n_smooth, l);
    if (cone <= 0.0) continue;
#ifndef CLOTH
    if (side <= 0.0) continue;
#endif
    vec3 strength = lights[i].color.rgb * cone * visibility(i, surface_world, side < 0.0 ? -n_smooth : n_smooth);
    float n_l = max(dot(n, l), 0.0) * smoothstep(0.0, 0.06, side);
    diffuse += strength * n_l;
#ifdef CLOTH
    // Light on the far side shines through between the threads.
    through += strength * max(-side, 0.0);
    gloss += strength * shine * highlight(n, v, l, max(alpha, 0.2), f0) * step(0.0, side);
#else
    gloss += strength * highlight(n, v, l, alpha, f0) * smoothstep(0.0, 0.06, side);
#endif
  }

  float rim = pow(1.0 - max(dot(n_smooth, v), 0.0), 4.0);
#ifdef CLOTH
  // Fibres that stand out catch light at grazing angles: a soft sheen in a paler tone of the cloth.
  vec3 sheen = mix(albedo, vec3(0.5), 0.35) * 0.55 * rim * diffuse;
  vec3 linear = albedo * (diffuse + 0.22 * behind * through) + sheen + gloss;
#else
  // A studio seen in the gloss: bright above, darker towards the ground.
  vec3 r = reflect(-v, n);
  float r_up = dot(r, frame.up_world.xyz);
  vec3 surroundings = mix(frame.ground_light.rgb * 0.6, frame.sky_light.rgb * 1.3, smoothstep(-0.25, 0.5, r_up));
  float mirror = (f0 + (1.0 - f0) * rim * (1.0 - roughness)) * open.x * open.y;
  vec3 linear = albedo * diffuse * (1.0 - mirror) + surroundings * mirror + gloss;
#endif
  color = vec4(display(linear), 1.0);
}
