#include "render/quality.hpp"

namespace weft::render {

// CPU ms at 1280x720 on one core (Zen 4, Mesa 22.3), 7,900 triangles of cloth on 2,000 of a sphere on a floor, preview
// and final: normals and upload 0.4, shadow map 3 and 6, geometry 8, soft light 11 and 40, shading of subjects 9 and
// 14, of floor 15, outlines 3, reading 2; together 54 and 92. Maps of 1536 texels cost 4 more and look the same.
QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {false, 512, 4, 6, 4, 3, 3, 4, 1500, false, false, false, true, false};
    case Quality::preview:
      return {true, 640, 5, 8, 4, 5, 5, 8, 1500, false, false, false, true, false};
    case Quality::final:
      break;
  }
  return {true, 1024, 10, 16, 2, 6, 7, 16, 5000, true, true, true, false, true};
}

}  // namespace weft::render
