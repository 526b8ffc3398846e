// Background: a seamless backdrop, into which the floor fades, or a sky.
vec3 backdrop_color(vec3 toward_world) {
  float up = dot(toward_world, frame.up_world.xyz);
  vec3 color = mix(frame.backdrop.rgb, frame.backdrop_top.rgb, smoothstep(-0.02, 0.6, up));
  // The backdrop is brighter behind the subjects, over an area that depends on their size in the picture.
  vec3 center = frame.center_world.xyz - frame.eye_world.xyz;
  float distance_sq = max(dot(center, center), 1e-6), size_sq = frame.eye_world.w * frame.eye_world.w / distance_sq;
  float off = 1.0 - dot(toward_world, center) * inversesqrt(distance_sq);
  return color * (1.0 - frame.backdrop.w * (1.0 - exp(-off / (1.5 * size_sq))));
}
