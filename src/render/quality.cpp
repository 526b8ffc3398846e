#include "render/quality.hpp"

namespace weft::render {

QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 512, 4, 6, 0, 1, 1};
    case Quality::preview:
      return {1, 1024, 8, 12, 3, 8, 8};
    case Quality::final:
      break;
  }
  return {4, 1536, 10, 16, 2, 12, 12};
}

}  // namespace weft::render
