// Light of the surroundings, and encoding to sRGB, for all passes that draw colours.
#include "frame.glsl"
#include "lights.glsl"
#include "surroundings.glsl"

// Encodes linear light to sRGB. Above 0.0031, roots approximate the curve of IEC 61966-2-1 with an error below 0.1/255,
// because three powers would take longer.
vec3 srgb(vec3 linear) {
  vec3 root = sqrt(linear);
  vec3 curve = 0.833761273 * root + 0.298103297 * sqrt(root) - 0.055321666 * linear - 0.076902919;
  return mix(12.92 * linear, curve, greaterThan(linear, vec3(0.0031308)));
}

// Applies exposure and tone curve to linear light, and encodes it to sRGB. If the look has a toe (Style::toe), dark
// tones become darker, as on film. Other colours below 0.8 stay unchanged. Above 0.8, the strongest channel is
// compressed toward 1, and very bright colours lose saturation.
vec3 encode(vec3 linear) {
  linear *= frame.floor_look.w;
  float toe = frame.horizon.w;
  linear *= (linear + toe) / (linear + 2.0 * toe + 1e-6);
  float peak = max(max(linear.r, linear.g), linear.b);
  if (peak > 0.8) {
    float bent = 1.0 - 0.2 * exp((0.8 - peak) * 5.0);
    linear = mix(linear * (bent / peak), vec3(bent), 1.0 - 1.0 / (0.15 * (peak - bent) + 1.0));
  }
  return srgb(linear);
}
