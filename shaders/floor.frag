// Infinite floor: lit as a matte surface near the subjects, in the backdrop's colour far away. OPEN: for most floor,
// where the soft light buffer shows neither shadow nor occlusion.
#include "shading.glsl"
#include "soft_look_up.glsl"
#include "bounced_light.glsl"
#include "open_floor.glsl"
#ifdef REFLECTING
#include "reflection.glsl"
#endif
layout(location = 0) out vec4 color;
#ifdef TILED
layout(binding = 16) uniform sampler2D floor_picture;
uniform vec4 picture_across, picture_up;  // maps from (x, y, z, 1) in the world
uniform float tint;
#endif

// Tiles of 0.5 m as a faint two-tone pattern, averaged over the pixel (box filter of a triangle wave, as in Quilez,
// "Filtering the checkerboard").
float tiles(vec2 at) {
  vec2 w = max(max(abs(dFdx(at)), abs(dFdy(at))), 1e-4);
  vec2 i = 2.0 * (abs(fract((at - 0.5 * w) * 0.5) - 0.5) - abs(fract((at + 0.5 * w) * 0.5) - 0.5)) / w;
  return 0.5 - 0.5 * i.x * i.y;
}

vec3 shaded_light(int i, Softness soft, FloorPoint at) {
  vec3 light = light_on_floor(i, at);
  return light * share_of_light(i, soft, ShadowPoint(at.position_world, at.n), light.g > 0.0);
}

void main() {
  vec3 up = frame.up_world.xyz, n = frame.floor_plane_world.xyz, albedo = frame.floor_look.rgb;
  vec3 ray_world = world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, 1.0));
  float distance_view = floor_distance(ray_world);
  vec3 position_world = frame.eye_world.xyz + distance_view * ray_world;
#ifdef TILED
  albedo = tint * texture(floor_picture, vec2(dot(picture_across, vec4(position_world, 1.0)),
                                       dot(picture_up, vec4(position_world, 1.0)))).rgb;
#endif
#ifdef CHECKER
  vec3 east = abs(up.x) > 0.5 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), north = cross(up, east);
  albedo *= mix(0.94, 1.0, tiles(vec2(dot(position_world, east), dot(position_world, north)) / 0.5));
#endif
#ifdef OPEN
  vec3 linear = open_floor(albedo, ray_world);
#else
  Softness soft = look_up_softness(distance_view, kFloor);
  vec4 bounced_here = bounced_light(position_world, n);
  // Floor does not occlude itself: all light that occluders reflect onto it is in the grid.
  FloorPoint at = floor_point(albedo, ray_world);
  vec3 shown = albedo * (irradiance(n) * min(soft.open, open_at_most(bounced_here.w)) + bounced_here.rgb);
  shown += shaded_light(0, soft, at);
#if LIGHTS > 1
  shown += shaded_light(1, soft, at);
#endif
#if LIGHTS > 2
  shown += shaded_light(2, soft, at);
#endif
#if LIGHTS > 3
  shown += shaded_light(3, soft, at);
#endif
  vec3 linear = fade_out(shown, position_world, ray_world);
#endif
  color = vec4(encode(linear), 1.0);
#ifdef REFLECTING
  // Schlick's approximation of Fresnel's law; a rough floor reflects less at grazing angles (Lagarde 2011).
  float roughness = frame.center_world.w, edge = 1.0 - max(-dot(normalize(ray_world), n), 0.0);
  float share = 0.04 + max(0.96 - roughness, 0.0) * edge * edge * edge * edge * edge;
  share *= 1.0 - away_from_subjects(position_world);
  color.rgb = srgb(reflect_in_floor(color.rgb, gl_FragCoord.xy * frame.viewport.zw, distance_view, roughness, share));
#endif
}
