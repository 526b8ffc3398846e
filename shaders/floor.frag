// The floor without end: lit like any matte surface near the subjects, the backdrop's own colour far away.
#include "shading.glsl"
#include "stage.glsl"
layout(location = 0) out vec4 color;

// Tiles of 0.5 m as a faint two-tone pattern, averaged over the pixel (box filter of a triangle wave, as in Quilez,
// "Filtering the checkerboard").
float tiles(vec2 at) {
  vec2 w = max(max(abs(dFdx(at)), abs(dFdy(at))), 1e-4);
  vec2 i = 2.0 * (abs(fract((at - 0.5 * w) * 0.5) - 0.5) - abs(fract((at + 0.5 * w) * 0.5) - 0.5)) / w;
  return 0.5 - 0.5 * i.x * i.y;
}

void main() {
  Seen seen = look_up_seen();
  vec3 up = frame.up_world.xyz, n = seen.normal_world, surface_world = seen.position_world;
  vec3 albedo = seen.front_roughness.rgb;
  if (seen.heat_checker.y > 0.0) {
    vec3 east = abs(up.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), north = cross(up, east);
    albedo *= mix(0.94, 1.0, tiles(vec2(dot(surface_world, east), dot(surface_world, north)) / 0.5));
  }
  Softness soft = look_up_softness(seen);
  vec3 diffuse = ambient_light(n, soft.open);
  int i = 0;
  do {
    float cone;
    vec3 l = toward_light(i, surface_world, cone);
    float n_l = max(dot(n, l), 0.0);
    float lit = share_of_light(i, soft, surface_world, n, n_l > 0.0);
    diffuse += lights[i].color.rgb * (cone * n_l * lit);
  } while (++i < light_count.x);
  // A pool of light round the subjects that runs out slowly.
  float away = max(length(surface_world - frame.center_world.xyz) / frame.eye_world.w - 1.5, 0.0) / 5.0;
  float far = away * away / (1.0 + away * away);
  color = vec4(display(mix(albedo * diffuse, backdrop_color(normalize(surface_world - frame.eye_world.xyz)), far)), 1.0);
}
