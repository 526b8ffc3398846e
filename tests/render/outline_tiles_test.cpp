#include "render/outline_tiles.hpp"

#include <gtest/gtest.h>

namespace weft::render {
namespace {

constexpr int kWidth = 61, kHeight = 37;  // no multiples of a tile

/// A plane: 1 / distance is linear over the picture.
std::vector<float> slanted_plane() {
  std::vector<float> distances;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      distances.push_back(1 / (0.5f + 0.004f * static_cast<float>(x) + 0.003f * static_cast<float>(y)));
    }
  }
  return distances;
}

// At the picture's edge the outermost row is repeated, which bends 1 / distance there: only the inside is looked at.
TEST(OutlineTiles, PlaneAtAnySlantHasNoOutlineInside) {
  const OutlineTiles tiles(slanted_plane(), kWidth, kHeight);
  EXPECT_FALSE(tiles.any(8, 8, 47, 31));
}

TEST(OutlineTiles, StepIsFoundInTheTilesOnBothItsSidesAndNowhereElse) {
  std::vector<float> distances(kWidth * kHeight, 3.0f);
  // A thing one percent nearer right of column 32, from row 8 on up.
  for (int y = 8; y < kHeight; ++y) {
    for (int x = 32; x < kWidth; ++x) distances[y * kWidth + x] = 2.97f;
  }
  const OutlineTiles tiles(distances, kWidth, kHeight);
  EXPECT_TRUE(tiles.any(24, 16, 31, 20));
  EXPECT_TRUE(tiles.any(32, 16, 39, 20));
  EXPECT_FALSE(tiles.any(16, 16, 23, 20));
  EXPECT_FALSE(tiles.any(40, 16, 60, 20));
  EXPECT_TRUE(tiles.any(48, 0, 50, 2));
  EXPECT_FALSE(tiles.any(0, 0, 23, 36));
  // A rectangle that spans the step, and ones that reach out of the picture.
  EXPECT_TRUE(tiles.any(0, 10, 60, 11));
  EXPECT_TRUE(tiles.any(-1e9f, -1e9f, 1e9f, 1e9f));
  EXPECT_FALSE(tiles.any(-500, 20, -400, 30));
}

}  // namespace
}  // namespace weft::render
