// Writes the surface data of each pixel, for deferred shading. Forward shading would cost more: llvmpipe shades a whole
// 4x4 block for every triangle that touches the block. With the small triangles of cloth, llvmpipe would shade about
// eight times as many pixels as are visible. The floor writes only distance_surface.
#include "frame.glsl"
const float kMaxRise = 0.02;  // limit on rise() [m]; needed at folds, where the normals of the corners differ much
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
in vec3 normal_squares, normal_products, plane;
uniform float surface;  // number of the surface
// normal_heat: world normal on the visible side; w: heat. The length of the normal is 1 + h; h: height of the smooth
// surface above the triangle along this normal [m].
layout(location = 0) out vec4 normal_heat;
layout(location = 1) out vec2 rest_uv;
layout(location = 2) out vec2 distance_surface;  // see "Surface numbers" in frame.glsl
#ifdef PAINTED
// `paint`: xyz: square root of the linear colour, for which 8 bits are enough. w: 0 if the pixel is not painted; from
// 0.6 (transparent) to 1 (opaque) if a picture covers a colour; else 1.
#ifdef PICTURED
in vec2 place;
layout(binding = 10) uniform sampler2D picture;  // linear, premultiplied
#endif
uniform int paint_mode;   // 0: not painted, 1: colour, 2: picture times colour, 3: picture over colour, 4: 2 with holes
uniform vec3 color;       // linear
uniform vec4 back_color;  // used if w < 0; else the back has the colour of the front, paler by w
layout(location = 3) out vec4 paint;
#endif
#ifdef TRIMMED
in vec3 trim_distances, trim_places;  // distances [m] and positions along the lines [m] of Trim (trims.hpp)
layout(location = 4) out vec4 trims;  // as read in trim.glsl
#endif
#ifdef PEELED
layout(binding = 12) uniform sampler2D peeled;  // distance of the layer drawn before; only surfaces behind it are drawn
#endif

// Height of the smooth surface above its triangle, along the normal [m]. A point of the smooth surface is the mean,
// with barycentric weights, of the projections of the triangle's point onto the tangent planes at the three corners
// (Hanika, "Hacking the Shadow Terminator", 2021).
float rise(vec3 n) {
  vec3 p = world_from_view(position_view(gl_FragCoord.xy * frame.viewport.zw, 1.0 / gl_FragCoord.w));
  vec3 products = normal_products.zxy * p.yzx + normal_products.yzx * p.zxy;
  return clamp(dot(n, plane - normal_squares * p - products), -kMaxRise, kMaxRise);
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
  // Ordered dithering with 4x4 thresholds (Bayer, "An optimum method for two-level rendition of continuous-tone
  // pictures", 1973), shifted for back faces, so that two layers do not hide each other's holes.
  const float kOrder[16] = float[](0., 8., 2., 10., 12., 4., 14., 6., 3., 11., 1., 9., 15., 7., 13., 5.);
  ivec2 pixel = ivec2(gl_FragCoord.xy) + (gl_FrontFacing ? 0 : 2) * ivec2(1, 1);
  if (texel.a < (2.0 * kOrder[4 * (pixel.y & 3) + (pixel.x & 3)] + 1.0) / 32.0) discard;
#endif
  if (paint_mode == 3) {
    front = color * (1.0 - texel.a) + texel.rgb;
    covered = 0.6 + 0.4 * texel.a;
  } else {
    front = color * texel.rgb / max(texel.a, 1e-3);
  }
#endif
  vec3 root = sqrt(front);
  if (!gl_FrontFacing) root = back_color.w < 0.0 ? sqrt(back_color.rgb) : mix(root, vec3(1.0), back_color.w);
  paint = paint_mode == 0 ? vec4(0.0) : vec4(root, covered);
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
