// What is seen at each pixel, for shading afterwards: llvmpipe shades whole 4x4 blocks of every triangle they touch,
// which for the small triangles of cloth is some eight times the pixels seen. Of the floor only `seen` is kept.
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
uniform float surface;
layout(location = 0) out vec4 normal_heat;       // world, toward the viewer
layout(location = 1) out vec2 rest_uv;
layout(location = 2) out vec2 distance_surface;  // frame.glsl
#ifdef PAINTED
// Of a picture with anything painted: 1 in w where it is, and the square root of linear colour, which bytes hold well.
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
void main() {
#ifdef PEELED
  if (1.0 / gl_FragCoord.w <= texelFetch(peeled, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
#ifdef PAINTED
  vec3 front = color;
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
  } else {
    front = color * texel.rgb / max(texel.a, 1e-3);
  }
#endif
  vec3 root = sqrt(front);
  if (!gl_FrontFacing) root = back_color.w < 0.0 ? sqrt(back_color.rgb) : mix(root, vec3(1.0), back_color.w);
  paint = laid == 0 ? vec4(0.0) : vec4(root, 1.0);
#endif
  normal_heat = vec4(gl_FrontFacing ? surface_normal_world : -surface_normal_world, surface_heat);
  rest_uv = surface_uv;
#ifdef TRIMMED
  bool other = trim_distances.y < trim_distances.x;
  float border = other ? trim_distances.y : trim_distances.x, seam = trim_distances.z;
  trims = vec4(border, seam, border <= seam ? (other ? trim_places.y : trim_places.x) : trim_places.z, 0.0);
#endif
  distance_surface = vec2(1.0 / gl_FragCoord.w, surface + (gl_FrontFacing ? 0.0 : 0.5));
}
