// Mip levels of a picture, and its opacity (the alpha channel), for passes on the CPU.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::render {

/// One mip level: premultiplied linear colour and alpha, rows from the bottom.
struct MipLevel {
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> texels;
};

/// The next smaller mip level: each texel is the mean of those that it covers. `level` must be larger than 1 x 1.
MipLevel next_mip_level(const MipLevel& level);

/// Mip level 0 of a texture. `opaque`: all texels have alpha 1.
MipLevel base_mip_level(const frame::Texture& texture, bool opaque);

/// The alpha channel of a picture with all mip levels.
class Opacity {
 public:
  /// `levels`: all mip levels, from level 0.
  Opacity(std::vector<MipLevel> levels, frame::Paint::Wrap wrap_u, frame::Paint::Wrap wrap_v);

  /// Interpolated opacity at a point of the picture (coordinates as in Paint::texture_from_uv). `footprint`: width of
  /// the sampled area [texels of level 0].
  float at(const Eigen::Vector2f& place, float footprint) const;
  /// Width and height of level 0 [texels].
  Eigen::Vector2f size() const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> alpha;
  };
  std::vector<Level> levels_;
  frame::Paint::Wrap wrap_u_, wrap_v_;
};

}  // namespace weft::render
