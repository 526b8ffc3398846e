// Rectangles of the picture, drawn to the stencil buffer only (Shading::mark_shaded_floor()).
layout(location = 0) in vec2 corner_clip;
void main() { gl_Position = vec4(corner_clip, 0.0, 1.0); }
