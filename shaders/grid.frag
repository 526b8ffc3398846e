// Colours interpolated from the corners of a grid, for slowly varying parts: backdrop, open floor under suns.
#include "frame.glsl"
noperspective in vec3 shown;
layout(location = 0) out vec4 color;
void main() { color = vec4(shown, 1.0); }
