// What each quality spends.
#pragma once

#include "render/renderer.hpp"

namespace weft::render {

struct QualitySettings {
  bool smooth_outlines;
  int shadow_size;   ///< texels of a shadow map's side; a multiple of 16
  int blocker_taps;  ///< of the search for what makes a penumbra
  int filter_taps;   ///< of the penumbra itself
  int soft_divisor;  ///< the picture of soft light is this much smaller
  int nearby_taps, sky_taps;
  int instants;        ///< sharp pictures that make one with motion blur or depth of field
  int bounce_cells;    ///< cubes about the subjects that hold what things throw on each other
  bool refines;        ///< cloth of few triangles is drawn with finer ones
  bool trims;          ///< hems, seams and edges of cloth, and cloth that is seen through
  bool mirrors;        ///< floors that shine show the subjects
  bool spots_on_grid;  ///< the pools of light of spots on open floor are lit at the corners of a grid, as that of suns
  bool crisp_shadows;  ///< search at full size along the edges of the first light's shadows on the subjects
};

QualitySettings quality_settings(Quality quality);

}  // namespace weft::render
