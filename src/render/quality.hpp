// Settings of each quality.
#pragma once

#include "render/renderer.hpp"

namespace weft::render {

struct QualitySettings {
  bool smooth_outlines;
  int shadow_size;   ///< texels along a side of a shadow map; a multiple of 16
  int blocker_taps;  ///< samples of the search for blockers
  int filter_taps;   ///< samples of the penumbra filter
  int soft_divisor;  ///< ratio of picture size to soft light buffer size
  int nearby_taps, sky_taps;
  int instants;        ///< sharp pictures averaged for motion blur or depth of field
  int bounce_cells;    ///< approximate number of grid cells for bounced light
  bool refines;        ///< draws cloth of few triangles with finer ones
  bool trims;          ///< hems, seams and edges of cloth, and translucent cloth
  bool mirrors;        ///< glossy floors reflect the subjects
  bool spots_on_grid;  ///< on open floor, light of spots is computed at the corners of a grid, as that of suns is
  bool crisp_shadows;  ///< blocker search at full size along the shadow edges of the first light on the subjects
};

QualitySettings quality_settings(Quality quality);

}  // namespace weft::render
