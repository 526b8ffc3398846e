#include "film/render/quality.hpp"

namespace weft::render {

// The cost of each stage is measured in tests/bench/history.md, section "render".
QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {false, 2, 4, 4, 4, 4, false, false, false, true};
    case Quality::preview:
      return {true, 2, 4, 4, 4, 8, false, false, false, true};
    case Quality::final:
      break;
  }
  return {true, 1, 2, 8, 4, 16, true, true, true, false};
}

}  // namespace weft::render
