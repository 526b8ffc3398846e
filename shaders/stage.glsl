// The studio round the subjects: a seamless backdrop into which the floor runs out.
vec3 backdrop_color(vec3 toward_world) {
  float up = dot(toward_world, frame.up_world.xyz);
  return frame.backdrop.rgb * mix(1.0, 0.62, smoothstep(0.0, 0.55, up));
}
