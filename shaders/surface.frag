// Cloth and solid surfaces: direct light with soft shadows, light of the sky, and the sheen or gloss of the material.
#include "shading.glsl"
#ifdef CLOTH
#include "weave.glsl"
#endif
layout(binding = 6) uniform sampler2D heat_colors;
layout(location = 0) out vec4 color;

// Microfacet highlight (GGX, Walter et al. 2007; visibility term by Hammon 2017), for reflectance f0 head-on.
float highlight(vec3 n, vec3 v, vec3 l, float alpha, float f0) {
  vec3 h = normalize(v + l);
  float n_h = max(dot(n, h), 0.0), n_l = max(dot(n, l), 0.0), n_v = max(dot(n, v), 1e-3), l_h = max(dot(l, h), 0.0);
  float a_sq = alpha * alpha, d = n_h * n_h * (a_sq - 1.0) + 1.0;
  float grazing = 1.0 - l_h, fresnel = f0 + (1.0 - f0) * grazing * grazing * grazing * grazing * grazing;
  return fresnel * a_sq / (d * d) * 0.25 / mix(2.0 * n_l * n_v, n_l + n_v, alpha) * 2.0 * n_l;
}

void main() {
  Seen seen = look_up_seen();
  vec3 v = normalize(frame.eye_world.xyz - seen.position_world);
  // Near outlines a smooth normal may lean away from the eye; bend it back to the horizon.
  vec3 n = normalize(seen.normal_world + v * max(0.02 - dot(seen.normal_world, v), 0.0));
  float roughness = seen.front_roughness.w;
#ifdef CLOTH
  vec3 albedo = seen.front ? seen.front_roughness.rgb : seen.back_spacing.rgb;
#else
  vec3 albedo = seen.front_roughness.rgb;
#endif
  vec3 n_smooth = n;
#ifdef CLOTH
  vec3 behind = seen.front ? seen.back_spacing.rgb : seen.front_roughness.rgb;
  float shine = 1.0;
  float spacing = seen.back_spacing.w;
  if (spacing > 0.0) {
    Weave woven = weave(seen.rest_uv, spacing, n, seen.position_world);
    n = woven.normal_world;
    albedo *= woven.tone;
    shine = woven.shine;
  }
#endif
  float heat_scale = seen.heat_checker.x;
  if (heat_scale > 0.0) {
    float hot = clamp(seen.heat * heat_scale, 0.0, 1.0);
    albedo = textureLod(heat_colors, vec2((hot * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
#ifdef CLOTH
    behind = albedo;
#endif
  }

  Softness soft = look_up_softness(seen);
  vec3 diffuse = ambient_light(n, soft.open);
  vec3 through = vec3(0.0), gloss = vec3(0.0);
  float alpha = max(roughness * roughness, 0.02), f0 = 0.04 * (1.0 - 0.9 * roughness * roughness);
  int i = 0;
  do {
    float cone;
    vec3 l = toward_light(i, seen.position_world, cone);
    float side = dot(n_smooth, l);
    // Solid surfaces take nothing from behind; cloth lets some through.
#ifdef CLOTH
    bool wanted = cone > 0.0;
#else
    bool wanted = cone > 0.0 && side > 0.0;
#endif
    float lit = share_of_light(i, soft, seen.position_world, side < 0.0 ? -n_smooth : n_smooth, wanted);
    vec3 strength = lights[i].color.rgb * (cone * lit);
    float n_l = max(dot(n, l), 0.0) * smoothstep(0.0, 0.06, side);
    diffuse += strength * n_l;
#ifdef CLOTH
    // Light on the far side shines through between the threads.
    through += strength * max(-side, 0.0);
    gloss += strength * shine * highlight(n, v, l, max(alpha, 0.2), f0) * step(0.0, side);
#else
    gloss += strength * highlight(n, v, l, alpha, f0) * smoothstep(0.0, 0.06, side);
#endif
  } while (++i < light_count.x);

  float edge = 1.0 - max(dot(n_smooth, v), 0.0), rim = edge * edge * edge * edge;
#ifdef CLOTH
  // Fibres that stand out catch light at grazing angles: a soft sheen in a paler tone of the cloth.
  vec3 sheen = mix(albedo, vec3(0.5), 0.35) * 0.55 * rim * diffuse;
  vec3 linear = albedo * (diffuse + 0.22 * behind * through) + sheen + gloss;
#else
  // A studio seen in the gloss: bright above, darker towards the ground.
  vec3 r = reflect(-v, n);
  float r_up = dot(r, frame.up_world.xyz);
  vec3 surroundings = mix(frame.ground_light.rgb * 0.6, frame.sky_light.rgb * 1.3, smoothstep(-0.25, 0.5, r_up));
  float mirror = (f0 + (1.0 - f0) * rim * (1.0 - roughness)) * soft.open;
  vec3 linear = albedo * diffuse * (1.0 - mirror) + surroundings * mirror + gloss;
#endif
  color = vec4(display(linear), 1.0);
}
