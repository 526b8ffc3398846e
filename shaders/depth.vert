// Depth alone, for shadow maps.
layout(location = 0) in vec3 position_world;
uniform mat4 clip_from_world;
void main() { gl_Position = clip_from_world * vec4(position_world, 1.0); }
