#include "shading.glsl"
#include "stage.glsl"
layout(location = 0) out vec4 color;
void main() {
  vec2 ndc = gl_FragCoord.xy * frame.viewport.zw * 2.0 - 1.0;
  vec3 toward_view = normalize(vec3(ndc * frame.frustum.xy, -1.0));
  color = vec4(display(backdrop_color(transpose(mat3(frame.view_from_world)) * toward_view)), 1.0);
}
