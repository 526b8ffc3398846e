#include "frame.glsl"
#include "dither.glsl"
noperspective in vec3 shown;
layout(location = 0) out vec4 color;
void main() { color = vec4(shown + dither(gl_FragCoord.xy), 1.0); }
