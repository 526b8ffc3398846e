#include "render/outline_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace weft::render {
namespace {

// A little below the shader's 1e-3, so that rounding cannot make it find an outline in a tile without a flag.
constexpr float kKink = 0.9e-3f;

/// Reciprocals of one row of distances, with the first and last repeated on either side.
void nearness_row(std::span<const float> distances, int width, int row, std::vector<float>& nearness) {
  const float* from = distances.data() + static_cast<std::size_t>(row) * width;
  for (int x = 0; x < width; ++x) nearness[x + 1] = 1 / from[x];
  nearness.front() = nearness[1];
  nearness.back() = nearness[width];
}

}  // namespace

OutlineTiles::OutlineTiles(std::span<const float> distances, int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      flags_(static_cast<std::size_t>(columns_) * rows_) {
  const std::size_t padded = static_cast<std::size_t>(columns_) * kTile + 2;
  std::vector<float> below(padded), here(padded), above(padded);
  std::vector<std::uint8_t> kinked(padded);
  std::vector<float>* rows[] = {&below, &here, &above};
  const auto load = [&](int row, std::vector<float>& into) {
    into.resize(static_cast<std::size_t>(width) + 2);
    nearness_row(distances, width, std::clamp(row, 0, height - 1), into);
  };
  load(0, *rows[0]);
  load(0, *rows[1]);
  for (int y = 0; y < height; ++y) {
    load(y + 1, *rows[2]);
    const float *low = rows[0]->data() + 1, *mid = rows[1]->data() + 1, *high = rows[2]->data() + 1;
    for (int x = 0; x < width; ++x) {
      const float across = std::abs(mid[x - 1] + mid[x + 1] - 2 * mid[x]);
      const float along = std::abs(low[x] + high[x] - 2 * mid[x]);
      kinked[x] = std::max(across, along) > kKink * mid[x];
    }
    std::uint8_t* flags = flags_.data() + static_cast<std::size_t>(y / kTile) * columns_;
    for (int x = 0; x < width; ++x) flags[x / kTile] |= kinked[x];
    std::rotate(rows, rows + 1, rows + 3);
  }
}

bool OutlineTiles::any(float x0, float y0, float x1, float y1) const {
  const auto tile = [](float pixel, int count) {
    return static_cast<int>(std::clamp(std::floor(pixel / kTile), 0.0f, static_cast<float>(count - 1)));
  };
  const int last_column = tile(x1, columns_), last_row = tile(y1, rows_);
  for (int row = tile(y0, rows_); row <= last_row; ++row) {
    for (int column = tile(x0, columns_); column <= last_column; ++column) {
      if (flags_[static_cast<std::size_t>(row) * columns_ + column]) return true;
    }
  }
  return false;
}

}  // namespace weft::render
