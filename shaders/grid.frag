// Interpolates colours from the corners of a grid, for parts of the picture that vary slowly: backdrop and open floor.
#include "frame.glsl"
noperspective in vec3 shown;
layout(location = 0) out vec4 color;
void main() { color = vec4(shown, 1.0); }
