#include "render/quality.hpp"

namespace weft::render {

// Costs of each stage: tests/bench/history.md, render. (Measured: shadow maps of 1536 texels cost 4 CPU ms more without
// a visible difference.)
QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {false, 512, 4, 6, 4, 3, 3, 4, 1500, false, false, false, true, false};
    case Quality::preview:
      return {true, 640, 5, 8, 4, 5, 5, 8, 1500, false, false, false, true, false};
    case Quality::final:
      break;
  }
  return {true, 1024, 20, 16, 2, 6, 7, 16, 5000, true, true, true, false, true};
}

}  // namespace weft::render
