// Takes in the neighbours within `radius` blocks along one axis, so that a block answers for every filter tap that
// starts in it.
uniform sampler2DArray ranges;
uniform int layer;
uniform ivec2 axis;
uniform int radius;
layout(location = 0) out vec2 range;
void main() {
  ivec2 block = ivec2(gl_FragCoord.xy), last = textureSize(ranges, 0).xy - 1;
  vec2 found = vec2(1.0, 0.0);
  for (int i = -radius; i <= radius; ++i) {
    vec2 d = texelFetch(ranges, ivec3(clamp(block + i * axis, ivec2(0), last), layer), 0).rg;
    found = vec2(min(found.x, d.x), max(found.y, d.y));
  }
  range = found;
}
