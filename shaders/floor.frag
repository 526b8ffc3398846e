// The floor without end: lit like any matte surface near the subjects, the backdrop's own colour far away.
#include "shading.glsl"
#include "stage.glsl"
in vec3 surface_world;
uniform vec3 front_color;  // linear
uniform bool checker;
layout(location = 0) out vec4 color;

// Tiles of 0.5 m as a faint two-tone pattern, averaged over the pixel (box filter of a triangle wave, as in Quilez,
// "Filtering the checkerboard").
float tiles(vec2 at) {
  vec2 w = max(max(abs(dFdx(at)), abs(dFdy(at))), 1e-4);
  vec2 i = 2.0 * (abs(fract((at - 0.5 * w) * 0.5) - 0.5) - abs(fract((at + 0.5 * w) * 0.5) - 0.5)) / w;
  return 0.5 - 0.5 * i.x * i.y;
}

void main() {
  vec3 up = frame.up_world.xyz, to_surface = surface_world - frame.eye_world.xyz;
  vec3 albedo = front_color;
  if (checker) {
    vec3 east = abs(up.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), north = cross(up, east);
    albedo *= mix(0.94, 1.0, tiles(vec2(dot(surface_world, east), dot(surface_world, north)) / 0.5));
  }
  vec3 diffuse = ambient_light(up, openness());
  for (int i = 0; i < light_count.x; ++i) {
    float cone;
    vec3 l = toward_light(i, surface_world, cone);
    float n_l = dot(up, l);
    if (n_l > 0.0 && cone > 0.0) diffuse += lights[i].color.rgb * cone * n_l * visibility(i, surface_world, up);
  }
  float away = length(surface_world - frame.center_world.xyz) / frame.eye_world.w;
  float far = smoothstep(2.0, 9.0, away);
  color = vec4(display(mix(albedo * diffuse, backdrop_color(normalize(to_surface)), far)), 1.0);
}
