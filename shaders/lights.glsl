// Direct light. SPOTS: some lights are spots.
struct Light {
  vec4 toward_light_world;        // w: squared distance of a spot from its target; sun: 0
  vec4 position_world;            // w: cosine of half the cone angle
  vec4 color;                     // linear; w: 1 / width of the soft edge of the cone
};
// LIGHTS of these are valid, at least one. Index by constants: llvmpipe reads a member at a variable index once per
// pixel.
layout(std140, binding = 1) uniform Lights { Light lights[4]; };
// Unit vector towards light i. `cone`: its intensity at the point within its cone, 1 at the target, with inverse square
// falloff.
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
