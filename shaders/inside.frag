// Pixels that no outline crosses: their colour stays, at depth 0, so that nothing drawn later touches them. Where
// something ends, 1 / distance, which is linear over the picture of any plane, has a kink or a step.
layout(binding = 8) uniform sampler2D distances;
layout(binding = 9) uniform sampler2D shaded;
layout(location = 0) out vec4 color;

float nearness(ivec2 pixel, ivec2 last) { return 1.0 / texelFetch(distances, clamp(pixel, ivec2(0), last), 0).r; }

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(shaded, 0) - 1;
  float center = nearness(here, last);
  float across = nearness(here + ivec2(1, 0), last) + nearness(here - ivec2(1, 0), last);
  float along = nearness(here + ivec2(0, 1), last) + nearness(here - ivec2(0, 1), last);
  if (max(abs(across - 2.0 * center), abs(along - 2.0 * center)) > 1e-3 * center) discard;
  color = texelFetch(shaded, here, 0);
}
