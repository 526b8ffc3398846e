// Environment light (surroundings.hpp); include after frame.glsl.

// Unoccluded irradiance on a surface with normal n, divided by pi: the light that a matte white surface shows.
vec3 irradiance(vec3 n) {
  vec3 sum = frame.irradiance[0].rgb + n.x * frame.irradiance[1].rgb + n.y * frame.irradiance[2].rgb +
             n.z * frame.irradiance[3].rgb + n.x * n.y * frame.irradiance[4].rgb + n.y * n.z * frame.irradiance[5].rgb +
             n.z * n.x * frame.irradiance[6].rgb + n.z * n.z * frame.irradiance[7].rgb +
             (n.x * n.x - n.y * n.y) * frame.irradiance[8].rgb;
  return max(sum, vec3(0.0));
}

// Environment light from a direction, blurred as by a reflection with roughness squared `alpha`.
vec3 surroundings(vec3 toward, float alpha) {
  float height = dot(toward, frame.up_world.xyz), blur = 0.08 + alpha;
  vec3 above = mix(frame.horizon.rgb, frame.sky.rgb, smoothstep(0.0, 1.0, height));
  vec3 sum = mix(frame.ground.rgb, above, smoothstep(-blur, blur, height));
  float own = 2.0 / (alpha * alpha + 1e-4);
  for (int i = 0; i < 3; ++i) {
    float ratio = own / (frame.box_axes[i].w + own);
    sum += frame.box_lights[i].rgb * (ratio * exp(ratio * frame.box_axes[i].w * (dot(frame.box_axes[i].xyz, toward) - 1.0)));
  }
  return sum;
}
