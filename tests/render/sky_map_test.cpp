#include "render/sky_map.hpp"

#include <gtest/gtest.h>

namespace weft::render {
namespace {

// Two horizontal squares of half side 1 at heights 0.25 and 0.75 in a box of 2 x 2 x 1. With a margin of 1 on each side
// the map is 4 m wide: 64 texels a metre.
TEST(SkyMap, TellsTheHighestAndTheLowestOverEachSpot) {
  const Box3 bounds(Vec3(-1, -1, 0), Vec3(1, 1, 1));
  const SkyView view = fit_sky(bounds, Vec3::UnitZ(), 1);
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto square = [](double x0, double x1, double z) {
    return std::vector<Vec3>{{x0, -1, z}, {x1, -1, z}, {x1, 1, z}, {x0, 1, z}};
  };
  const std::vector<Vec3> low = square(-1, 1, 0.25), high = square(-1, 0, 0.75);
  const std::vector<DrawnMesh> meshes = {{low, triangles}, {high, triangles}};
  std::vector<SkyTexel> map;
  draw_sky_map(meshes, view, map);

  const auto height = [&](float depth) { return 1.01 - depth * view.depth_metres; };
  int only_low = 0, both = 0, none = 0;
  for (const SkyTexel& texel : map) {
    if (texel.highest == 1) {
      EXPECT_EQ(texel.lowest, 0);
      ++none;
      continue;
    }
    EXPECT_NEAR(height(texel.lowest), 0.25, 1e-6);
    const bool covered = height(texel.highest) > 0.5;
    EXPECT_NEAR(height(texel.highest), covered ? 0.75 : 0.25, 1e-6);
    ++(covered ? both : only_low);
  }
  EXPECT_EQ(both, 64 * 128);
  EXPECT_EQ(only_low, 64 * 128);
  EXPECT_EQ(none, 256 * 256 - 128 * 128);
}

TEST(SkyMap, WhatReachesOutOfTheMapIsCutOffAndWhatIsSeenEdgeOnIsNotThere) {
  const SkyView view = fit_sky(Box3(Vec3(-1, -1, 0), Vec3(1, 1, 1)), Vec3::UnitZ(), 1);
  const std::vector<Vec3> positions = {{-50, -50, 0.5}, {50, -50, 0.5}, {0, 90, 0.5}, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}};
  const std::vector<Triangle> wide = {{0, 1, 2}}, upright = {{3, 4, 5}};
  std::vector<SkyTexel> map;
  const std::vector<DrawnMesh> cut = {{positions, wide}}, edge_on = {{positions, upright}};
  draw_sky_map(cut, view, map);
  for (const SkyTexel& texel : map) EXPECT_LT(texel.highest, 1);
  draw_sky_map(edge_on, view, map);
  for (const SkyTexel& texel : map) EXPECT_EQ(texel.highest, 1);
}

}  // namespace
}  // namespace weft::render
