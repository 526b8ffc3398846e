// Distances of the pixels that the small picture looks at, close together: the search for what is nearby reads them all
// over, and those of the whole picture do not fit into a processor's cache.
#include "soft_light.glsl"
layout(binding = 8) uniform sampler2D distances_surfaces;
layout(location = 0) out float distance_view;
void main() { distance_view = texelFetch(distances_surfaces, min(small_to_full(ivec2(gl_FragCoord.xy)), textureSize(distances_surfaces, 0) - 1), 0).r; }
