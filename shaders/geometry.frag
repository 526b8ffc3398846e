// Surface data of each pixel for deferred shading. Without it, llvmpipe would shade whole 4x4 blocks for every triangle
// that touches them: for the small triangles of cloth, about eight times the visible pixels. The floor writes only
// distance_surface.
#include "frame.glsl"
const float kMostRise = 0.02;  // limit of rise() [m], for triangles at folds, whose corner normals differ too much
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
in vec3 normal_squares, normal_products, plane;
uniform float surface;
layout(location = 0) out vec4 normal_heat;       // world, towards the viewer; length 1 + rise of the surface [m]
layout(location = 1) out vec2 rest_uv;
layout(location = 2) out vec2 distance_surface;  // frame.glsl
#ifdef PAINTED
// Output for the paint of a pixel. xyz: square root of the linear colour, which needs only 8 bits. w: above 0.5 if the
// pixel is painted; below 1 if its picture lies over a colour and is transparent there.
#ifdef PICTURED
in vec2 place;
layout(binding = 10) uniform sampler2D picture;  // linear, premultiplied
#endif
uniform int laid;         // 0 not painted, 1 plain colour, 2 picture times colour, 3 over colour, 4 as 2 with holes
uniform vec3 color;       // linear
uniform vec4 back_color;  // w < 0: colour of the back; else the back is the front, paler by w
layout(location = 3) out vec4 paint;
#endif
#ifdef TRIMMED
in vec3 trim_distances, trim_places;  // border, border beyond a corner, seam
layout(location = 4) out vec4 trims;  // trim.glsl
#endif
#ifdef PEELED
layout(binding = 12) uniform sampler2D peeled;  // distances up to which layers are already peeled
#endif

// Height of the smooth surface above its triangle, along the normal [m]: the mean of the tangent planes at the corners,
// with barycentric weights (Hanika, "Hacking the Shadow Terminator", 2021).
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
  // The 4x4 thresholds of opacity.hpp, shifted for back faces, so that two layers do not hide each other's holes.
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
