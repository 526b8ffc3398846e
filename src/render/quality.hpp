// Settings of each quality.
#pragma once

#include "render/renderer.hpp"

namespace weft::render {

struct QualitySettings {
  bool smooth_outlines;
  int shadow_divisor;   ///< ratio of picture size to that of the shadows
  int ambient_divisor;  ///< ratio of picture size to that of the light from surroundings and surfaces
  int shadow_rays;      ///< rays of each pixel in a penumbra, for each lamp; prime to 5
  int ambient_rays;     ///< rays of each of its points for the latter
  int instants;         ///< sharp pictures averaged for motion blur or depth of field
  bool refines;         ///< draws cloth of few triangles with finer ones
  bool trims;           ///< hems, seams and edges of cloth, and translucent cloth
  bool mirrors;         ///< glossy floors reflect the subjects
  bool spots_on_grid;   ///< on open floor, light of spots is computed at the corners of a grid, as that of suns is
};

QualitySettings quality_settings(Quality quality);

}  // namespace weft::render
