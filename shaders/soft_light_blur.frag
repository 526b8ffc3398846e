// Mean openness over pixels of the same surface, along one axis at a time: evens out the noise of the taps, keeps
// outlines. The share of light is softened over a pixel only, with SHARES_TOO: its steps would show as a sawtooth at full
// size.
#include "soft_light.glsl"
layout(binding = 3) uniform sampler2D soft_light_map;
uniform ivec2 axis;
#ifdef SHARES_TOO
// Of a pixel's two neighbours against its own.
const float kBeside = 0.5;
// Change of a light's share from texel to texel beyond which it is not blurred away: on floor, and on what is curved, where
// half of it may be noise of the faces.
const float kCrispFloor = 0.25, kCrispCurved = 0.45;
#endif
layout(location = 0) out vec4 soft_light;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(soft_light_map, 0) - 1;
  vec4 taps[5];
  for (int i = 0; i < 5; ++i) taps[i] = texelFetch(soft_light_map, clamp(here + (i - 2) * axis, ivec2(0), last), 0);
  vec4 center = taps[2];
  // How the surface goes on to both sides, so that slanted ones count in full and the noise of all taps cancels out.
  float before = center.w - taps[1].w, after = taps[3].w - center.w;
  float slope = before * after > 0.0 ? sign(after) * min(abs(before), abs(after)) : 0.0;
  vec2 sum = vec2(soft_open(center), 1.0);
#ifdef SHARES_TOO
  vec2 here_lit = soft_lit(center), steepest = vec2(0.0);
  vec3 lit = vec3(here_lit, 1.0);
#endif
  for (int i = 0; i < 5; ++i) {
    if (i == 2) continue;
    // A step of 2 percent of the distance is another fold.
    float off = abs(taps[i].w - center.w - float(i - 2) * slope) / (0.01 * center.w);
    float same = soft_surface(taps[i]) == soft_surface(center) ? clamp(2.0 - off, 0.0, 1.0) : 0.0;
    sum += vec2(soft_open(taps[i]), 1.0) * same;
#ifdef SHARES_TOO
    if (abs(i - 2) != 1) continue;
    vec2 there = soft_lit(taps[i]);
    lit += vec3(there, 1.0) * (kBeside * same);
    steepest = max(steepest, abs(there - here_lit) * step(0.01, same));
#endif
  }
  soft_light = vec4(pack_soft(soft_surface(center), sum.x / sum.y), center.yz, center.w);
#ifdef SHARES_TOO
  // Pixels beside what is crisp search for themselves: what is blurred here would lie as a second line along the edge.
  vec2 crisp = max(soft_crisp(center), step(soft_surface(center) == 1.0 ? kCrispFloor : kCrispCurved, steepest));
  soft_light.yz = lit.xy / lit.z - 2.0 * crisp;
#endif
}
