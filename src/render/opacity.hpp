// The opacity of a picture for passes on the processor.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// One of a picture's sizes, each half of the one before: linear light times alpha, and alpha; rows from the bottom.
struct MipLevel {
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> texels;
};

/// The next smaller size: each texel is the mean of what it covers. Of one by one there is none.
MipLevel half_of(const MipLevel& level);

/// The picture at its own size; `opaque` takes its alpha for 1.
MipLevel full_size(const frame::Texture& texture, bool opaque);

class Opacity {
 public:
  Opacity(std::vector<MipLevel> levels, frame::Paint::Wrap wrap_u, frame::Paint::Wrap wrap_v);

  /// At a place of the picture, between texels; `footprint`: width of what is asked for, in texels of the full size.
  float at(const Eigen::Vector2f& place, float footprint) const;
  /// Width and height of the full size [texels].
  Eigen::Vector2f size() const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> alpha;
  };
  std::vector<Level> levels_;
  frame::Paint::Wrap wrap_u_, wrap_v_;
};

/// Thresholds from 1/32 to 31/32 that are spread evenly over any 4×4 neighbours: of an opacity between them so many
/// are opaque (Bayer, "An optimum method for two-level rendition of continuous-tone pictures", 1973).
inline float threshold_at(int x, int y) {
  constexpr std::uint8_t kOrder[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return (2.0f * static_cast<float>(kOrder[4 * (y & 3) + (x & 3)]) + 1.0f) / 32.0f;
}

}  // namespace weft::render
