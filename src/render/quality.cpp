#include "render/quality.hpp"

namespace weft::render {

QualitySettings quality_settings(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 512, 4, 6, 0, 1, 1};
    case Quality::preview:
      return {1, 1024, 8, 10, 3, 7, 7};
    case Quality::final:
      break;
  }
  return {4, 1536, 10, 16, 2, 10, 9};
}

}  // namespace weft::render
