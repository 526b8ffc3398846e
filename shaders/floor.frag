// Infinite floor. Near the subjects, the floor is lit; far away, it fades into the backdrop. OPEN: variant for pixels
// of open floor (floor without shadow, occlusion or reflected light); these are most pixels of the floor.
#include "shading.glsl"
#include "traced_light.glsl"
#include "open_floor.glsl"
#ifdef REFLECTING
#include "reflection.glsl"
#endif
layout(location = 0) out vec4 color;
#ifdef TILED
layout(binding = 16) uniform sampler2D floor_picture;
uniform vec4 picture_across, picture_up;  // rows of the map from world (x, y, z, 1) to picture coordinates
uniform float tint;  // factor on the colour of the picture
#endif

// Checkerboard, from 0 to 1, averaged over the pixel (box filter of a triangle wave, as in Quilez, "Filtering the
// checkerboard"). `at`: position [tiles].
float tiles(vec2 at) {
  vec2 w = max(max(abs(dFdx(at)), abs(dFdy(at))), 1e-4);
  vec2 i = 2.0 * (abs(fract((at - 0.5 * w) * 0.5) - 0.5) - abs(fract((at + 0.5 * w) * 0.5) - 0.5)) / w;
  return 0.5 - 0.5 * i.x * i.y;
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
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 lit = texelFetch(lamps_lit, pixel, 0), from_surfaces = texelFetch(surface_light, pixel, 0);
  FloorPoint at = floor_point(albedo, ray_world);
  vec3 shown = albedo * (irradiance(n) * from_surfaces.w + from_surfaces.rgb);
  shown += lit.x * light_on_floor(0, at);
#if LIGHTS > 1
  shown += lit.y * light_on_floor(1, at);
#endif
#if LIGHTS > 2
  shown += lit.z * light_on_floor(2, at);
#endif
#if LIGHTS > 3
  shown += lit.w * light_on_floor(3, at);
#endif
  vec3 linear = fade_out(shown, position_world, ray_world);
#endif
  color = vec4(encode(linear), 1.0);
#ifdef REFLECTING
  // Schlick's approximation of Fresnel's equations; a rough floor reflects less at grazing angles (Lagarde 2011).
  float roughness = frame.center_world.w, edge = 1.0 - max(-dot(normalize(ray_world), n), 0.0);
  float reflectance = 0.04 + max(0.96 - roughness, 0.0) * edge * edge * edge * edge * edge;
  reflectance *= 1.0 - away_from_subjects(position_world);
  color.rgb = srgb(reflect_in_floor(color.rgb, gl_FragCoord.xy * frame.viewport.zw, distance_view, roughness,
                                    reflectance));
#endif
}
