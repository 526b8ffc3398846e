// Mean openness over pixels of the same surface, along one axis at a time: evens out the noise of the taps, keeps
// outlines. The share of light is softened over a pixel only: its steps would show as a sawtooth at full size.
#include "soft_light.glsl"
layout(binding = 3) uniform sampler2D soft_light_map;
uniform ivec2 axis;
layout(location = 0) out vec4 soft_light;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(soft_light_map, 0) - 1;
  vec4 center = texelFetch(soft_light_map, here, 0);
  vec2 sum = vec2(soft_open(center), 1.0);
  vec3 lit = vec3(center.yz, 1.0);
  for (int i = -RADIUS; i <= RADIUS; ++i) {
    if (i == 0) continue;
    vec4 tap = texelFetch(soft_light_map, clamp(here + i * axis, ivec2(0), last), 0);
    // A step of 2 percent of the distance is another fold.
    float same = soft_surface(tap) == soft_surface(center) ? max(1.0 - abs(tap.w - center.w) / (0.02 * center.w), 0.0) : 0.0;
    sum += vec2(soft_open(tap), 1.0) * same;
    if (abs(i) == 1) lit += vec3(tap.yz, 1.0) * (0.5 * same);
  }
  soft_light = vec4(pack_soft(soft_surface(center), sum.x / sum.y), lit.xy / lit.z, center.w);
}
