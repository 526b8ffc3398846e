// Floor that nothing shades or hides from the sky, as the ray of a pixel meets it, in linear light.
#include "stage.glsl"

vec3 light_on_floor(int i, vec3 position_world, vec3 n) {
  float cone;
  vec3 l = toward_light(i, position_world, cone);
  return lights[i].color.rgb * (cone * max(dot(n, l), 0.0));
}

// 0 near the subjects, to 1 far from them.
float away_from_subjects(vec3 position_world) {
  float away = max(length(position_world - frame.center_world.xyz) / frame.eye_world.w - 1.5, 0.0) / 5.0;
  return away * away / (1.0 + away * away);
}

// A pool of light round the subjects that runs out slowly into the backdrop.
vec3 fade_out(vec3 color, vec3 position_world, vec3 ray_world) {
  return mix(color, backdrop_color(normalize(ray_world)), away_from_subjects(position_world));
}

// How far the ray of a pixel, one metre along the view axis, goes [m]. Rays to the floor go down; so close to the horizon
// that rounding denies it, all is backdrop.
float floor_distance(vec3 ray_world) {
  return frame.floor_plane_world.w / max(-dot(frame.floor_plane_world.xyz, ray_world), 1e-6);
}

vec3 open_floor(vec3 albedo, vec3 ray_world) {
  vec3 n = frame.floor_plane_world.xyz;
  vec3 position_world = frame.eye_world.xyz + floor_distance(ray_world) * ray_world;
  vec3 diffuse = irradiance(n) + light_on_floor(0, position_world, n);
#if LIGHTS > 1
  diffuse += light_on_floor(1, position_world, n);
#endif
#if LIGHTS > 2
  diffuse += light_on_floor(2, position_world, n);
#endif
#if LIGHTS > 3
  diffuse += light_on_floor(3, position_world, n);
#endif
  return fade_out(albedo * diffuse, position_world, ray_world);
}
