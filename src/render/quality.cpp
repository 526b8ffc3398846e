#include "render/quality.hpp"

namespace weft::render {

QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 512, 6, 8, 0, 1, 1};
    case Quality::preview:
      return {1, 1024, 8, 12, 3, 8, 8};
    case Quality::final:
      break;
  }
  return {4, 2048, 16, 24, 2, 14, 14};
}

}  // namespace weft::render
