// Settings of each quality.
#pragma once

#include "film/render/renderer.hpp"

namespace weft::render {

struct QualitySettings {
  bool smooth_outlines;
  int shadow_divisor;   ///< ratio of picture size to that of the shadows
  int ambient_divisor;  ///< ratio of picture size to that of the light from surroundings and surfaces
  int shadow_rays;      ///< rays per lamp for each shadow point in a penumbra; no multiple of 5, see trace_lamp()
  int ambient_rays;     ///< rays per point for the light from surroundings and surfaces
  int instants;         ///< sharp pictures averaged for depth of field; at most this number for motion blur alone
  bool refines;         ///< draws cloth that has few triangles with four times as many
  bool trims;           ///< draws hems, seams and edges of cloth, and translucent cloth
  bool mirrors;         ///< glossy floors reflect the subjects
  bool spots_on_grid;   ///< computes the light of spots on open floor only at the corners of a grid, like that of suns
};

QualitySettings quality_settings(Quality quality);

}  // namespace weft::render
