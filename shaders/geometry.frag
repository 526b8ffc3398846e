in vec3 surface_normal_world;
layout(location = 0) out vec4 packed_normal_world;
void main() {
  vec3 n = normalize(surface_normal_world);
  packed_normal_world = vec4((gl_FrontFacing ? n : -n) * 0.5 + 0.5, 1.0);
}
