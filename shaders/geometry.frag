// What is seen at each pixel, for shading afterwards: llvmpipe shades whole 4x4 blocks of every triangle they touch,
// which for the small triangles of cloth is some eight times the pixels seen. Of the floor only `seen` is kept.
#include "frame.glsl"
const float kMostRise = 0.02;  // [m]: where normals of a fold's two sides meet they say nothing
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
in vec3 normal_squares, normal_products, plane;
uniform float surface;
layout(location = 0) out vec4 normal_heat;       // world, toward the viewer; longer than 1 by the rise of the surface [m]
layout(location = 1) out vec2 rest_uv;
layout(location = 2) out vec2 distance_surface;  // frame.glsl
#ifdef PAINTED
// Of a picture with anything painted: above 0.5 in w where it is, less than 1 as far as a picture over a colour leaves
// that, and the square root of linear colour, which bytes hold well.
#ifdef PICTURED
in vec2 place;
layout(binding = 10) uniform sampler2D picture;  // linear, times alpha
#endif
uniform int laid;         // 0 not painted, 1 plain, 2 the picture times color, 3 over color, 4 the same with holes
uniform vec3 color;       // linear
uniform vec4 back_color;  // where w is below 0; else the front, paler by w
layout(location = 3) out vec4 paint;
#endif
#ifdef TRIMMED
in vec3 trim_distances, trim_places;  // border, border beyond a corner, seam
layout(location = 4) out vec4 trims;  // trim.glsl
#endif
#ifdef PEELED
layout(binding = 12) uniform sampler2D peeled;  // distances up to which all is taken off already
#endif

// By how much the smooth surface that the triangles stand for lies outside of them [m]: the mean of the planes through the
// corners, by their shares of the place (Hanika, "Hacking the Shadow Terminator", 2021), along the normal.
float rise(vec3 n) {
  vec3 p = world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, 1.0 / gl_FragCoord.w));
  vec3 products = normal_products.zxy * p.yzx + normal_products.yzx * p.zxy;
  return clamp(dot(n, plane - normal_squares * p - products), -kMostRise, kMostRise);
}

void main() {
#ifdef PEELED
  if (1.0 / gl_FragCoord.w <= texelFetch(peeled, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
#ifdef PAINTED
  vec3 front = color;
  float covered = 1.0;
#ifdef PICTURED
  vec4 texel = texture(picture, place);
#ifdef HOLES
  // The 4x4 thresholds of opacity.hpp, others for the back, so that two layers do not hide each other's holes.
  const float kOrder[16] = float[](0., 8., 2., 10., 12., 4., 14., 6., 3., 11., 1., 9., 15., 7., 13., 5.);
  ivec2 pixel = ivec2(gl_FragCoord.xy) + (gl_FrontFacing ? 0 : 2) * ivec2(1, 1);
  if (texel.a < (2.0 * kOrder[4 * (pixel.y & 3) + (pixel.x & 3)] + 1.0) / 32.0) discard;
#endif
  if (laid == 3) {
    front = color * (1.0 - texel.a) + texel.rgb;
    covered = 0.6 + 0.4 * texel.a;
  } else {
    front = color * texel.rgb / max(texel.a, 1e-3);
  }
#endif
  vec3 root = sqrt(front);
  if (!gl_FrontFacing) root = back_color.w < 0.0 ? sqrt(back_color.rgb) : mix(root, vec3(1.0), back_color.w);
  paint = laid == 0 ? vec4(0.0) : vec4(root, covered);
#endif
  vec3 n = normalize(surface_normal_world);
  float side = gl_FrontFacing ? 1.0 : -1.0;
  normal_heat = vec4((side + rise(n)) * n, surface_heat);
  rest_uv = surface_uv;
#ifdef TRIMMED
  bool other = trim_distances.y < trim_distances.x;
  float border = other ? trim_distances.y : trim_distances.x, seam = trim_distances.z;
  trims = vec4(border, seam, border <= seam ? (other ? trim_places.y : trim_places.x) : trim_places.z, 0.0);
#endif
  distance_surface = vec2(1.0 / gl_FragCoord.w, surface + (gl_FrontFacing ? 0.0 : 0.5));
}
