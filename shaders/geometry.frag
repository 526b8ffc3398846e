// What is seen at each pixel, for shading afterwards: llvmpipe shades whole 4x4 blocks of every triangle they touch,
// which for the small triangles of cloth is some eight times the pixels seen. Of the floor only `seen` is kept.
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
uniform float surface;
layout(location = 0) out vec4 normal_heat;       // world, toward the viewer
layout(location = 1) out vec2 rest_uv;
layout(location = 2) out vec2 distance_surface;  // frame.glsl
void main() {
  normal_heat = vec4(gl_FrontFacing ? surface_normal_world : -surface_normal_world, surface_heat);
  rest_uv = surface_uv;
  distance_surface = vec2(1.0 / gl_FragCoord.w, surface + (gl_FrontFacing ? 0.0 : 0.5));
}
