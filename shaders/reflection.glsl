// Reflections of the subjects in a glossy floor (mirror.hpp); include after shading.glsl.
layout(binding = 13) uniform sampler2D mirror;            // upside down, sRGB encoded; mip levels for blur
layout(binding = 14) uniform sampler2D mirror_distances;  // distance from eye via floor to reflected surface [m]
const int kMirrorTaps = 8;  // number of texture samples per pixel

// sRGB to linear light, with an error below 0.5/255 (a cubic fitted to IEC 61966-2-1).
vec3 decode(vec3 srgb) { return srgb * (srgb * (srgb * 0.305306011 + 0.682171111) + 0.012522878); }

// Blends the reflection by `weight` over the floor's colour (sRGB); returns linear light. `distance_view`:
// distance of the floor along the view axis [m].
vec3 reflect_in_floor(vec3 color, vec2 uv, float distance_view, float roughness, float weight) {
  vec2 at = vec2(uv.x, 1.0 - uv.y);
  // A rough floor scatters light into a cone (`cone`: tangent of its half angle), so that the blur radius grows with
  // the distance from the floor to the reflected surface. This distance is that of the nearest surface in the pixels
  // around, so that outlines are blurred evenly.
  float cone = 0.5 * roughness * roughness, nearest = textureLod(mirror_distances, at, 0.0).r;
  vec2 aspect = vec2(frame.frustum.y / frame.frustum.x, 1.0);
  float widest = 0.5 * cone / frame.frustum.y;
  vec2 direction = first_direction(0.3);
  for (int k = 0; k < kMirrorTaps; ++k) {
    vec2 offset = sqrt((float(k) + 0.5) / float(kMirrorTaps)) * 0.5 * widest * direction * aspect;
    nearest = min(nearest, textureLod(mirror_distances, at + offset, 0.0).r);
    direction = next_direction(direction);
  }
  float radius = widest * clamp(1.0 - distance_view / nearest, 0.0, 1.0);
  float level = log2(max(radius * float(textureSize(mirror, 0).y), 1.0));
  vec3 sum = vec3(0.0);
  direction = first_direction(pixel_noise(gl_FragCoord.xy));
  for (int k = 0; k < kMirrorTaps; ++k) {
    vec2 offset = sqrt((float(k) + 0.5) / float(kMirrorTaps)) * radius * direction * aspect;
    sum += decode(textureLod(mirror, at + offset, max(level - 1.0, 0.0)).rgb);
    direction = next_direction(direction);
  }
  return mix(decode(color), sum / float(kMirrorTaps), weight);
}
