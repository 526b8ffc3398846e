#include "render/soft_blur.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/seen.hpp"

namespace weft::render {
namespace {

constexpr int kTexelsAcross = 37, kTexelsDown = 23;  // no multiple of eight
constexpr float kOpen = 0.9375f;                     // shaders/soft_light.glsl

float open_of(const SoftTexel& texel) {
  return (texel.surface_open - std::floor(texel.surface_open)) / kOpen;
}

/// Texels of one inclined surface, lit everywhere; `open` gives the openness of each place.
template <class Open>
std::vector<SoftTexel> slope(const Open& open) {
  std::vector<SoftTexel> texels;
  for (int y = 0; y < kTexelsDown; ++y)
    for (int x = 0; x < kTexelsAcross; ++x)
      texels.push_back({kFirstSurface + kOpen * open(x, y), {1, 1}, 2 + 0.03f * static_cast<float>(x + 2 * y)});
  return texels;
}

// The taps differ between texels so that any 5x5 window contains the same 25 values: only their mean remains, except
// where the border cuts the window. Single precision: 24 sums of numbers below 1 round by 1e-6 at most.
TEST(SoftBlur, NoiseOfTheTapsCancelsOnASlope) {
  const auto noise = [](int x, int y) { return static_cast<float>((5 * ((x + 2 * y) % 5) + (y + 2 * x) % 5)) / 25; };
  std::vector<SoftTexel> texels = slope(noise);
  SoftBlur(kTexelsAcross, kTexelsDown).smooth(texels);
  for (int y = 4; y < kTexelsDown - 4; ++y)
    for (int x = 4; x < kTexelsAcross - 4; ++x)
      EXPECT_NEAR(open_of(texels[y * kTexelsAcross + x]), 0.48, 1e-5) << x << " " << y;
}

// This holds also for an object that lies on a floor, at the same distance.
TEST(SoftBlur, OutlinesAreKept) {
  std::vector<SoftTexel> texels = slope([](int, int) { return 0.25f; });
  for (int y = 0; y < kTexelsDown; ++y)
    for (int x = 20; x < kTexelsAcross; ++x)
      texels[y * kTexelsAcross + x] = {
          kFloor + kOpen * 0.75f, {0, 1}, y < 12 ? 9 : texels[y * kTexelsAcross + x].distance};
  std::vector<SoftTexel> smoothed = texels;
  SoftBlur(kTexelsAcross, kTexelsDown).smooth(smoothed);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    EXPECT_NEAR(smoothed[i].surface_open, texels[i].surface_open, 1e-6) << i;
    EXPECT_EQ(smoothed[i].lit[0], texels[i].lit[0]) << i;
    EXPECT_EQ(smoothed[i].distance, texels[i].distance) << i;
  }
}

// Across and then down: the texels on both sides of an edge are reported, and earlier reports are kept.
TEST(SoftBlur, EdgesTooCrispForTheSmallPictureAreToldOf) {
  std::vector<SoftTexel> texels = slope([](int, int) { return 1.0f; });
  for (int y = 0; y < kTexelsDown; ++y) {
    for (int x = 0; x < kTexelsAcross; ++x) {
      texels[y * kTexelsAcross + x].lit[0] = x < 10 ? 0.0f : 1.0f;
      texels[y * kTexelsAcross + x].lit[1] = 0.04f * static_cast<float>(x % 20);
    }
  }
  texels[5 * kTexelsAcross + 30].lit[1] -= 2;
  SoftBlur(kTexelsAcross, kTexelsDown).smooth(texels);
  for (int x = 0; x < kTexelsAcross; ++x)
    EXPECT_EQ(texels[5 * kTexelsAcross + x].lit[0] <= -0.5f, x == 9 || x == 10) << x;
  for (int x = 0; x < kTexelsAcross; ++x)
    EXPECT_EQ(texels[5 * kTexelsAcross + x].lit[1] <= -0.5f, x == 19 || x == 20 || x == 30) << x;
}

}  // namespace
}  // namespace weft::render
