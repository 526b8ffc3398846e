#include "film/render/opacity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "film/image/color.hpp"

namespace weft::render {
namespace {

using Wrap = frame::Paint::Wrap;

/// One texel of a row or column of the smaller level: weights of the texels that it covers, from `first` on.
struct TexelWeights {
  int first = 0;
  std::vector<float> weights;
};
std::vector<TexelWeights> texel_weights(int from, int to) {
  std::vector<TexelWeights> all;
  const double width = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * width, end = begin + width;
    TexelWeights texel{static_cast<int>(begin), {}};
    for (int k = texel.first; k < from && k < end; ++k)
      texel.weights.push_back(static_cast<float>((std::min(end, k + 1.0) - std::max(begin, double(k))) / width));
    all.push_back(std::move(texel));
  }
  return all;
}

/// Texel index after wrapping; -1 outside a picture with Wrap::once.
int wrap_texel(int texel, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return ((texel % size) + size) % size;
    case Wrap::clamp:
      return std::clamp(texel, 0, size - 1);
    case Wrap::mirror: {
      const int turn = ((texel % (2 * size)) + 2 * size) % (2 * size);
      return turn < size ? turn : 2 * size - 1 - turn;
    }
    case Wrap::once:
      return texel < 0 || texel >= size ? -1 : texel;
  }
  return -1;
}

}  // namespace

MipLevel next_mip_level(const MipLevel& level) {
  MipLevel half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
  const std::vector<TexelWeights> columns = texel_weights(level.width, half.width),
                                  rows = texel_weights(level.height, half.height);
  half.texels.reserve(static_cast<std::size_t>(half.width) * half.height);
  for (const TexelWeights& row : rows) {
    for (const TexelWeights& column : columns) {
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      for (std::size_t j = 0; j < row.weights.size(); ++j) {
        const Eigen::Vector4f* line =
            level.texels.data() + (static_cast<std::size_t>(row.first) + j) * level.width + column.first;
        for (std::size_t i = 0; i < column.weights.size(); ++i) sum += row.weights[j] * column.weights[i] * line[i];
      }
      half.texels.push_back(sum);
    }
  }
  return half;
}

MipLevel base_mip_level(const frame::Texture& texture, bool opaque) {
  static const auto kLinear = [] {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(image::linear_from_srgb(i / 255.0));
    return table;
  }();
  MipLevel level{texture.width, texture.height, {}};
  level.texels.reserve(static_cast<std::size_t>(texture.width) * texture.height);
  for (int y = texture.height - 1; y >= 0; --y) {
    const std::uint8_t* row = texture.rgba.data() + 4 * static_cast<std::size_t>(y) * texture.width;
    for (int x = 0; x < texture.width; ++x, row += 4) {
      const float alpha = opaque ? 1.0f : static_cast<float>(row[3]) / 255.0f;
      level.texels.emplace_back(alpha * kLinear[row[0]], alpha * kLinear[row[1]], alpha * kLinear[row[2]], alpha);
    }
  }
  return level;
}

Opacity::Opacity(std::vector<MipLevel> levels, Wrap wrap_u, Wrap wrap_v) : wrap_u_(wrap_u), wrap_v_(wrap_v) {
  for (const MipLevel& from : levels) {
    Level& level = levels_.emplace_back(Level{from.width, from.height, {}});
    level.alpha.reserve(from.texels.size());
    for (const Eigen::Vector4f& texel : from.texels)
      level.alpha.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(texel.w(), 0.0f, 1.0f))));
  }
}

Eigen::Vector2f Opacity::size() const {
  return {static_cast<float>(levels_.front().width), static_cast<float>(levels_.front().height)};
}

float Opacity::at(const Eigen::Vector2f& place, float footprint) const {
  const int nearest = static_cast<int>(std::lround(std::log2(std::max(footprint, 1.0f))));
  const Level& level = levels_[static_cast<std::size_t>(std::clamp(nearest, 0, static_cast<int>(levels_.size()) - 1))];
  const float x = place.x() * static_cast<float>(level.width) - 0.5f;
  const float y = place.y() * static_cast<float>(level.height) - 0.5f;
  if (!(std::abs(x) < 1e9f && std::abs(y) < 1e9f)) return 1;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float right = x - static_cast<float>(column), up = y - static_cast<float>(row);
  float sum = 0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int at_x = wrap_texel(column + i, level.width, wrap_u_), at_y = wrap_texel(row + j, level.height, wrap_v_);
      if (at_x < 0 || at_y < 0) continue;
      const float weight = (i ? right : 1 - right) * (j ? up : 1 - up);
      sum += weight * static_cast<float>(level.alpha[static_cast<std::size_t>(at_y) * level.width + at_x]);
    }
  }
  return sum / 255.0f;
}

}  // namespace weft::render
