// What is seen at each pixel, for shading afterwards: llvmpipe shades whole 4x4 blocks of every triangle they touch,
// which for the small triangles of cloth is some eight times the pixels seen.
in vec3 surface_normal_world;
in vec2 surface_uv;
in float surface_heat;
uniform float material;
layout(location = 0) out vec4 normal_world;      // toward the viewer
layout(location = 1) out vec4 uv_heat_material;  // material + 0.5 where the back is seen
layout(location = 2) out float distance_view;    // along the view axis [m]
void main() {
  normal_world = vec4(gl_FrontFacing ? surface_normal_world : -surface_normal_world, 0.0);
  uv_heat_material = vec4(surface_uv, surface_heat, material + (gl_FrontFacing ? 0.0 : 0.5));
  distance_view = 1.0 / gl_FragCoord.w;
}
