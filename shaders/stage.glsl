// The studio round the subjects: a seamless backdrop into which the floor runs out, brightest at the horizon.
vec3 backdrop_color(vec3 toward_world) {
  float up = dot(toward_world, frame.up_world.xyz);
  return frame.backdrop.rgb * mix(1.0, 0.55, smoothstep(-0.02, 0.5, up));
}
