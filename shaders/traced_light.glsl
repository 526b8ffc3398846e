// Light of each pixel, computed by rays (traced_light.hpp).
layout(binding = 0) uniform sampler2D lamps_lit;         // visible fraction of each of four lights
layout(binding = 1) uniform sampler2D surface_light;     // light of surfaces, as matte white shows it; w: open fraction
layout(binding = 2) uniform sampler2D mirrored_surfaces;  // light of mirrored surfaces; w: fraction that they cover
