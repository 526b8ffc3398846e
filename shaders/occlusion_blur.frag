// Mean over 5x5 pixels of the same surface along one axis at a time: evens out the noise of the taps, keeps outlines.
uniform sampler2D occlusion_map;
uniform ivec2 axis;
layout(location = 0) out vec4 occlusion;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(occlusion_map, 0) - 1;
  vec4 center = texelFetch(occlusion_map, here, 0);
  vec3 sum = vec3(center.xy, 1.0);
  for (int i = -RADIUS; i <= RADIUS; ++i) {
    if (i == 0) continue;
    vec3 tap = texelFetch(occlusion_map, clamp(here + i * axis, ivec2(0), last), 0).xyz;
    // A step of 2 percent of the distance is another surface.
    float same = max(1.0 - abs(tap.z - center.z) / (0.02 * center.z), 0.0);
    sum += vec3(tap.xy, 1.0) * same;
  }
  occlusion = vec4(sum.xy / sum.z, center.z, 0.0);
}
