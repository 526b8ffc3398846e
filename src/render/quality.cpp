#include "render/quality.hpp"

namespace weft::render {

// CPU ms at 1280x720 on two shared, busy cores (Zen 5, Mesa 22.3), 16,200 triangles of cloth on 9,200 of a sphere on a
// floor, medians: draft 117, final 235 to 240; preview 120 to 127 with the taps it had before (8, 10, 7, 7). Of final:
// normals and upload 4, shadow map 30, geometry 25, soft light 58, shading 65, outlines 50. One map of 2048 texels
// costs 12 more, of 1024 10 less.
QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {false, 512, 4, 6, 4, 3, 3, false};
    case Quality::preview:
      return {true, 640, 5, 8, 4, 5, 5, false};
    case Quality::final:
      break;
  }
  return {true, 1024, 10, 16, 2, 6, 7, true};
}

}  // namespace weft::render
