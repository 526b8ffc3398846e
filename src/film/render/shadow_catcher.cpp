#include "film/render/shadow_catcher.hpp"

#include <algorithm>

#include "film/render/pixels.hpp"

namespace weft::render {

std::vector<float> floor_shadows(std::span<const Seen> seen, std::span<const std::uint64_t> shaded,
                                 std::span<const std::uint64_t> open, int width, int height) {
  std::vector<float> shadows(seen.size(), 0);
  const auto is_floor = [&](std::size_t i) { return seen[i].surface == kFloor; };
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    if (!is_floor(i)) continue;
    const float light = linear_of(open[i]).sum();
    shadows[i] = light > 0 ? std::clamp(1 - linear_of(shaded[i]).sum() / light, 0.0f, 1.0f) : 0;
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      if (is_floor(i)) continue;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
        for (int k = std::max(x - 1, 0); k <= std::min(x + 1, width - 1); ++k) {
          const std::size_t near = static_cast<std::size_t>(j) * width + k;
          if (is_floor(near)) shadows[i] = std::max(shadows[i], shadows[near]);
        }
      }
    }
  }
  return shadows;
}

}  // namespace weft::render
