// Light of each pixel, computed by rays (traced_light.hpp).
layout(binding = 0) uniform sampler2D lamps_lit;          // visible fraction of each of four lights
// Irradiance from other surfaces, divided by pi; w: fraction of the surroundings that no surface covers.
layout(binding = 1) uniform sampler2D surface_light;
// Light of mirrored surfaces; w: fraction of the mirror image that they cover.
layout(binding = 2) uniform sampler2D mirrored_surfaces;
