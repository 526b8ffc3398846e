// Copies the distances of the pixels that the soft light buffer samples into a small texture: the search for nearby
// occluders reads them repeatedly, and those of the full picture do not fit into the CPU's cache.
#include "soft_light.glsl"
layout(binding = 8) uniform sampler2D distances_surfaces;
layout(location = 0) out float distance_view;
void main() { distance_view = texelFetch(distances_surfaces, min(small_to_full(ivec2(gl_FragCoord.xy)), textureSize(distances_surfaces, 0) - 1), 0).r; }
