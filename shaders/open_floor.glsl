// Light of open floor (floor without shadow, occlusion or reflected light) at the point that the ray of a pixel hits.
#include "stage.glsl"

#ifdef SHINY
#include "highlight.glsl"
#endif

// Intersection of the ray of a pixel with the floor. n: normal; v: unit vector to the eye.
struct FloorPoint {
  vec3 position_world, n, v, albedo;
};

// Light i, reflected by the floor. SHINY: adds a highlight of the lamp.
vec3 light_on_floor(int i, FloorPoint at) {
  float cone;
  vec3 l = toward_light(i, at.position_world, cone);
  vec3 shown = at.albedo * max(dot(at.n, l), 0.0);
#ifdef SHINY
  float roughness = frame.center_world.w;
  shown += highlight(at.n, at.v, l, max(roughness * roughness, 0.05), head_on(roughness));
#endif
  return lights[i].color.rgb * cone * shown;
}

// Fraction of backdrop in the floor: 0 up to 1.5 radii (frame.eye_world.w) from the centre of the subjects, rising to 1
// far away.
float away_from_subjects(vec3 position_world) {
  float away = max(length(position_world - frame.center_world.xyz) / frame.eye_world.w - 1.5, 0.0) / 5.0;
  return away * away / (1.0 + away * away);
}

// Fades the floor into the backdrop as the distance from the subjects grows.
vec3 fade_out(vec3 color, vec3 position_world, vec3 ray_world) {
  return mix(color, backdrop_color(normalize(ray_world)), away_from_subjects(position_world));
}

// Distance of the floor along the view axis [m]. The component of `ray_world` along this axis is 1 m. The bound 1e-6
// avoids a division by zero for rays near the horizon, where the floor has faded into the backdrop.
float floor_distance(vec3 ray_world) {
  return frame.floor_plane_world.w / max(-dot(frame.floor_plane_world.xyz, ray_world), 1e-6);
}

FloorPoint floor_point(vec3 albedo, vec3 ray_world) {
  vec3 position_world = frame.eye_world.xyz + floor_distance(ray_world) * ray_world;
  return FloorPoint(position_world, frame.floor_plane_world.xyz, -normalize(ray_world), albedo);
}

// Linear light of open floor.
vec3 open_floor(vec3 albedo, vec3 ray_world) {
  FloorPoint at = floor_point(albedo, ray_world);
  vec3 shown = albedo * irradiance(at.n) + light_on_floor(0, at);
#if LIGHTS > 1
  shown += light_on_floor(1, at);
#endif
#if LIGHTS > 2
  shown += light_on_floor(2, at);
#endif
#if LIGHTS > 3
  shown += light_on_floor(3, at);
#endif
  return fade_out(shown, at.position_world, ray_world);
}
