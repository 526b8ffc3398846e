// Removes noise from the small buffer of soft light (soft_light.hpp) on the CPU: its texels are read back anyway, and
// this takes 5 CPU ms for each picture against 22 in llvmpipe.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace weft::render {

/// Number of lights whose fractions the buffer stores.
inline constexpr std::size_t kSoftLights = 2;

/// Layout as packed in shaders/soft_light.glsl.
struct SoftTexel {
  float surface_open, lit[kSoftLights], distance;
};

/// Averages openness over five texels of the same surface, horizontally and then vertically; outlines are kept. The
/// light fractions are blurred over one pixel only, because their steps would be visible as a sawtooth at full size.
class SoftBlur {
 public:
  SoftBlur(int width, int height);

  void smooth(std::vector<SoftTexel>& texels);

 private:
  /// Texels row by row; each row has padding at both ends that repeats its last texels.
  using Plane = std::vector<float>;
  struct LightFraction {
    Plane lit;
    Plane too_crisp;  // >= 0 where a shadow edge is too sharp for this size
  };
  struct Planes {
    Plane open;
    std::array<LightFraction, kSoftLights> lights;
  };

  template <bool kWithLights>
  void pass(const Planes& from, Planes& to, bool across) const;
  void extend(Plane& plane, int y) const;
  std::size_t row_start(int y) const;

  int width_, height_;
  std::size_t stride_;
  Plane surface_, distance_;
  Planes planes_, other_;
};

}  // namespace weft::render
