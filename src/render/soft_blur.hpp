// Evens out the noise of the small picture of soft light (soft_light.hpp), on the processor: its texels are read
// anyway, and llvmpipe took 22 CPU ms of a picture for what takes 5 here.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace weft::render {

/// Lights whose shares the small picture holds.
inline constexpr std::size_t kSoftLights = 2;

/// As shaders/soft_light.glsl packs it.
struct SoftTexel {
  float surface_open, lit[kSoftLights], distance;
};

/// Mean openness over five texels of the same surface, across and then down: outlines are kept. The shares of light are
/// softened over a pixel only: their steps would show as a sawtooth at full size.
class SoftBlur {
 public:
  SoftBlur(int width, int height);

  void smooth(std::vector<SoftTexel>& texels);

 private:
  /// Texels row by row, each row with what lies beyond its ends, which is as they are.
  using Plane = std::vector<float>;
  struct Shares {
    Plane lit;
    Plane too_crisp;  // not negative where an edge is too crisp for this size
  };
  struct Planes {
    Plane open;
    std::array<Shares, kSoftLights> lights;
  };

  template <bool kShares>
  void pass(const Planes& from, Planes& to, bool across) const;
  void extend(Plane& plane, int y) const;
  std::size_t place(int y) const;

  int width_, height_;
  std::size_t stride_;
  Plane surface_, distance_;
  Planes planes_, other_;
};

}  // namespace weft::render
