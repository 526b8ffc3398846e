// Light from the sky, ambient occlusion, reflections and the way to the screen; used by all drawn surfaces.
#include "frame.glsl"
#include "lights.glsl"
layout(binding = 3) uniform sampler2D occlusion_map;

// Nearby openness and sky openness at this pixel, from the four half-size neighbours of like distance.
vec2 openness() {
#ifdef OCCLUSION
  vec2 uv = gl_FragCoord.xy * frame.viewport.zw;
  vec4 distances = textureGather(occlusion_map, uv, 2);
  float distance_view = 1.0 / gl_FragCoord.w;
  vec2 f = fract(uv * vec2(textureSize(occlusion_map, 0)) - 0.5);
  vec4 weights = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y)) + 0.02;
  weights *= max(1.0 - abs(distances - distance_view) / (0.03 * distance_view), 1e-3);
  weights /= dot(weights, vec4(1.0));
  return vec2(dot(weights, textureGather(occlusion_map, uv, 0)), dot(weights, textureGather(occlusion_map, uv, 1)));
#else
  return vec2(1.0);
#endif
}

// Light that a matte white surface takes from its surroundings: the sky above, the ground below, a little more from the
// camera's left, as a big window would give, so that shadowed folds keep their relief.
vec3 ambient_light(vec3 n_world, vec2 open) {
  float upward = 0.5 + 0.5 * dot(n_world, frame.up_world.xyz);
  vec3 light = mix(frame.ground_light.rgb, frame.sky_light.rgb, upward);
  light *= 1.0 - 0.18 * dot(n_world, frame.right_world.xyz) * (1.0 - abs(2.0 * upward - 1.0));
  return light * open.x * open.y;
}

// Linear light to the sRGB bytes of the picture. Below 0.8 nothing changes; brighter light is bent towards 1 by its
// strongest channel, all channels alike, so that no hue shifts.
vec3 display(vec3 linear) {
  float peak = max(max(linear.r, linear.g), linear.b);
  if (peak > 0.8) linear *= (1.0 - 0.2 * exp((0.8 - peak) * 5.0)) / peak;
  vec3 encoded = mix(12.92 * linear, 1.055 * pow(max(linear, 1e-6), vec3(1.0 / 2.4)) - 0.055, greaterThan(linear, vec3(0.0031308)));
  // Half a level of noise keeps wide gradients from showing their steps.
  return encoded + (pixel_noise(gl_FragCoord.yx) - 0.5) / 255.0;
}
