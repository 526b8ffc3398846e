#include "render/quality.hpp"

namespace weft::render {

QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 512, 4, 6, 4, 3, 3, false};
    case Quality::preview:
      return {1, 768, 8, 10, 4, 7, 7, false};
    case Quality::final:
      break;
  }
  return {4, 1536, 10, 16, 2, 10, 9, true};
}

}  // namespace weft::render
