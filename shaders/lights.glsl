// Direct light. SPOTS: some lights are spots.
struct Light {
  vec4 toward_light_world;        // unit; w: squared distance of a spot from its target [m²]; sun: 0
  vec4 position_world;            // w: cosine of half the cone angle
  vec4 color;                     // linear; w: 1 / width of the soft edge of the cone, as a difference of cosines
};
// The first LIGHTS entries (at least one) are valid. Shaders index them by constants: with a variable index, llvmpipe
// would read a member again for each pixel.
layout(std140, binding = 1) uniform Lights { Light lights[4]; };
// Returns the unit vector toward light i. `cone`: relative intensity of the light at the point. For a sun, `cone` is 1.
// For a spot, it is 0 outside of the cone, 1 at the target, and inversely proportional to the squared distance.
vec3 toward_light(int i, vec3 position_world, out float cone) {
  cone = 1.0;
#ifdef SPOTS
  if (lights[i].toward_light_world.w == 0.0) return lights[i].toward_light_world.xyz;
  vec3 way = lights[i].position_world.xyz - position_world;
  float way_sq = max(dot(way, way), 1e-6);
  vec3 toward = way * inversesqrt(way_sq);
  float cosine = dot(toward, lights[i].toward_light_world.xyz);
  cone = smoothstep(0.0, 1.0, (cosine - lights[i].position_world.w) * lights[i].color.w) * lights[i].toward_light_world.w / way_sq;
  return toward;
#else
  return lights[i].toward_light_world.xyz;
#endif
}
