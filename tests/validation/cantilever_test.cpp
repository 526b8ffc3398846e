// A strip that overhangs its clamp against the heavy elastica, light and heavy; all of the curve: cantilever_slow.cpp.
#include "validation/cantilever.hpp"

namespace weft::simulation {
namespace {

using scene::ClothShape;

TEST(CantileverStrip, LightOrHeavyFollowsTheElastica) {
  constexpr int kCells = 40;
  for (const testing::ElasticaPoint& point : {testing::kHeavyElastica[1], testing::kHeavyElastica[7]})
    for (ClothShape shape : {ClothShape::quads, ClothShape::aligned_triangles}) {
      const scene::Scene scene =
          testing::cantilever(shape, testing::overhang(point.gamma, testing::Route::density), kCells);
      EXPECT_NEAR(testing::drop_over_reach_of_run(scene, kCells), point.drop_over_reach, 0.01 * point.drop_over_reach)
          << testing::name_of(shape) << ", gamma " << point.gamma;
    }
}

}  // namespace
}  // namespace weft::simulation
