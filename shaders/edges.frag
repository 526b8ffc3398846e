// The shaded picture once more on the multisampled geometry, for clean outlines: each fragment takes the colour of its
// own surface from the pixel it lies in, or, where that shows another surface, from the neighbour most like it.
layout(binding = 8) uniform sampler2D distances;
layout(binding = 9) uniform sampler2D shaded;
layout(location = 0) out vec4 color;
#ifdef REST
uniform float rest_distance;
#endif

float unlike(ivec2 pixel, float distance_view) {
  return abs(texelFetch(distances, pixel, 0).r - distance_view);
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(shaded, 0) - 1, best = here;
#ifdef REST
  float distance_view = rest_distance, tolerance = 0.5 * rest_distance;
#else
  float distance_view = 1.0 / gl_FragCoord.w, tolerance = 2e-3 * distance_view;
#endif
  float least = unlike(here, distance_view);
  // A loop of no rounds where the pixel's own surface is meant; see lights.glsl.
  int neighbours = least > tolerance ? 4 : 0;
  for (int i = 0; i < neighbours; ++i) {
    ivec2 step = (i & 1) * 2 - 1 == 1 ? ivec2(1, 0) : ivec2(-1, 0);
    ivec2 there = clamp(here + (i < 2 ? step : step.yx), ivec2(0), last);
    float difference = unlike(there, distance_view);
    best = difference < least ? there : best;
    least = min(difference, least);
  }
  color = texelFetch(shaded, best, 0);
}
