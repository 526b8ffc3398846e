// The settings of the renderer for each Quality.
#pragma once

#include "film/render/renderer.hpp"

namespace weft::render {

struct QualitySettings {
  bool smooth_outlines;  ///< antialiasing (Outlines)
  int shadow_divisor;    ///< distance of the points at which shadows are traced [pixels]
  int ambient_divisor;   ///< distance of the points at which light from surroundings and surfaces is traced [pixels]
  int shadow_rays;       ///< rays per lamp for each point in a penumbra; must not be a multiple of 5 (trace_lamp())
  int ambient_rays;      ///< rays per point for the light from surroundings and surfaces
  int instants;          ///< number of sharp pictures averaged for depth of field; maximum number for motion blur alone
  bool refines;          ///< draws cloth with few triangles as a smooth surface with four times as many triangles
  bool trims;            ///< draws hems, seams and thickness of cloth, and translucent cloth
  bool mirrors;          ///< glossy floors reflect the subjects
  bool spots_on_grid;    ///< the light of spots on open floor may be interpolated on a grid
};

QualitySettings quality_settings(Quality quality);

}  // namespace weft::render
