// Light from the sky and the way to the screen; used by all that is drawn.
#include "frame.glsl"
#include "lights.glsl"

// Light that a matte white surface takes from its surroundings: the sky above, the ground below, a little more from the
// camera's left, as a big window would give, so that shadowed folds keep their relief.
vec3 ambient_light(vec3 n_world, float open) {
  float upward = 0.5 + 0.5 * dot(n_world, frame.up_world.xyz);
  vec3 light = mix(frame.ground_light.rgb, frame.sky_light.rgb, upward);
  light *= 1.0 - 0.18 * dot(n_world, frame.right_world.xyz) * (1.0 - abs(2.0 * upward - 1.0));
  return light * open;
}

// Linear light to the sRGB bytes of the picture. Below 0.8 nothing changes; brighter light is bent towards 1 by its
// strongest channel, all channels alike, so that no hue shifts.
vec3 encode(vec3 linear) {
  float peak = max(max(linear.r, linear.g), linear.b);
  if (peak > 0.8) linear *= (1.0 - 0.2 * exp((0.8 - peak) * 5.0)) / peak;
  // The curve of IEC 61966-2-1 by roots, fitted to within 0.1/255 on [0.0031, 1]: three powers cost 25 ns a pixel more.
  vec3 root = sqrt(linear);
  vec3 curve = 0.833761273 * root + 0.298103297 * sqrt(root) - 0.055321666 * linear - 0.076902919;
  return mix(12.92 * linear, curve, greaterThan(linear, vec3(0.0031308)));
}
