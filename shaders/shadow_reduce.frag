// Nearest and farthest depth in each block of 4x4 texels of the layer (first pass: depth map; second: its result), so
// that most pixels know from one look that they are lit or shadowed.
uniform sampler2DArray depths;
uniform int layer;
layout(location = 0) out vec2 range;
void main() {
  ivec2 block = ivec2(gl_FragCoord.xy) * 4;
  vec2 found = vec2(1.0, 0.0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      vec2 d = texelFetch(depths, ivec3(block + ivec2(x, y), layer), 0).rg;
#ifdef FROM_DEPTH
      // Where no caster is, nothing is dark, however far.
      d.g = d.r == 1.0 ? 1e9 : d.r;
#endif
      found = vec2(min(found.x, d.x), max(found.y, d.y));
    }
  }
  range = found;
}
