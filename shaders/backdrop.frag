// Where nothing is: the studio itself.
#include "shading.glsl"
#include "stage.glsl"
#include "dither.glsl"
layout(location = 0) out vec4 color;
void main() {
  vec3 toward_view = normalize(position_view(gl_FragCoord.xy * frame.viewport.zw, 1.0));
  color = vec4(encode(backdrop_color(world_from_view(toward_view))) + dither(gl_FragCoord.xy), 1.0);
}
