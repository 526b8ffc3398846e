// Pictures of one view in several sizes. Their content must look alike in all sizes.
#pragma once

#include "film/render/renderer.hpp"

namespace weft::render {

inline constexpr int kWidth = 160, kHeight = 100;  // size of a picture at scale 1 [pixels]

/// Draws a picture of `scale` times kWidth x kHeight pixels.
inline image::Image drawn(const frame::FrameSnapshot& snapshot, int scale, Quality quality = Quality::final) {
  Settings settings;
  settings.width = scale * kWidth;
  settings.height = scale * kHeight;
  settings.quality = quality;
  return Renderer(settings).draw(snapshot);
}

/// Mean green level of a block of `size` x `size` pixels with the upper left corner (x0, y0).
inline double mean(const image::Image& image, int x0, int y0, int size) {
  double sum = 0;
  for (int y = y0; y < y0 + size; ++y)
    for (int x = x0; x < x0 + size; ++x) sum += image.pixel(x, y)[1];
  return sum / (size * size);
}

}  // namespace weft::render
