// What rays found for each pixel (traced_light.hpp).
layout(binding = 0) uniform sampler2D lamps_lit;         // fraction of each of four lights
layout(binding = 1) uniform sampler2D surface_light;     // light from surfaces, as matte white shows it; w: open fraction
layout(binding = 2) uniform sampler2D mirrored_surfaces;  // light from surfaces in a mirror; w: hidden fraction
