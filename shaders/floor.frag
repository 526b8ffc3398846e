// The floor without end: lit like any matte surface near the subjects, the backdrop's own colour far away. OPEN: where
// the small picture shows neither shadow nor occlusion, as most floor is.
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

vec3 light_on_floor(int i, Softness soft, vec3 position_world, vec3 n) {
  float cone;
  vec3 l = toward_light(i, position_world, cone);
  float n_l = max(dot(n, l), 0.0);
#ifdef OPEN
  return lights[i].color.rgb * (cone * n_l);
#else
  return lights[i].color.rgb * (cone * n_l * share_of_light(i, soft, position_world, n, n_l > 0.0));
#endif
}

void main() {
  vec3 up = frame.up_world.xyz, n = frame.floor_plane_world.xyz;
  vec3 ray_world = world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, 1.0));
  // Rays to the floor go down; so close to the horizon that rounding denies it, all is backdrop.
  float distance_view = frame.floor_plane_world.w / max(-dot(n, ray_world), 1e-6);
  vec3 position_world = frame.eye_world.xyz + distance_view * ray_world;
  vec3 albedo = frame.floor_look.rgb;
  if (frame.floor_look.w > 0.0) {
    vec3 east = abs(up.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), north = cross(up, east);
    albedo *= mix(0.94, 1.0, tiles(vec2(dot(position_world, east), dot(position_world, north)) / 0.5));
  }
#ifdef OPEN
  Softness soft = kAllOpen;
#else
  Softness soft = look_up_softness(distance_view, kFloor);
#endif
  vec3 diffuse = ambient_light(n, soft.open) + light_on_floor(0, soft, position_world, n);
#if LIGHTS > 1
  diffuse += light_on_floor(1, soft, position_world, n);
#endif
#if LIGHTS > 2
  diffuse += light_on_floor(2, soft, position_world, n);
#endif
#if LIGHTS > 3
  diffuse += light_on_floor(3, soft, position_world, n);
#endif
  // A pool of light round the subjects that runs out slowly.
  float away = max(length(position_world - frame.center_world.xyz) / frame.eye_world.w - 1.5, 0.0) / 5.0;
  float far = away * away / (1.0 + away * away);
  color = vec4(display(mix(albedo * diffuse, backdrop_color(normalize(ray_world)), far)), 1.0);
}
