// Tests of regions of cloth behind a flat layer, whose bounding box has no depth, and of ways out of bodies.
#include "physics/untangle/ways_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "collision/hierarchy/test_meshes.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::untangle {
namespace {

/// A square layer of 1 m at z = 0, whose front is up, and a square cloth of 0.4 m over its middle. The cloth has the
/// `slope` dz/dx; its middle is at the `height` [m].
struct ClothOnLayer {
  static constexpr int kCells = 8;
  std::vector<Vec3> x;
  collision::Bodies bodies;
  std::vector<std::uint8_t> movable;

  ClothOnLayer(double slope, double height) {
    add(0.2, slope, height, {.deformable = true, .thickness = 0.002});
    movable.assign(x.size(), 1);
    add(0.5, 0, 0, {.thickness = 0.002});
    movable.resize(x.size(), 0);
  }
  void add(double half_width, double slope, double height, const collision::BodyTraits& traits) {
    constexpr Index kRow = kCells + 1;
    for (Index j = 0; j < kRow; ++j)
      for (Index i = 0; i < kRow; ++i) {
        const double u = half_width * (2.0 * i / kCells - 1), v = half_width * (2.0 * j / kCells - 1);
        x.emplace_back(u, v, height + slope * u);
      }
    bodies.add(collision::testing::grid_triangles(kRow), kRow * kRow, traits);
  }
  /// Calls test(input, layer).
  template <class Test>
  void with_layer(const Test& test) const {
    const std::vector<Vec3> rest(x.begin(), x.begin() + (kCells + 1) * (kCells + 1));
    const UntangleInput input(bodies, {SurfaceKind::cloth, SurfaceKind::layer}, x, rest, movable);
    const collision::BroadPhase surfaces(bodies.surfaces(), x);
    test(input, ForbiddenRegion(surfaces, 1, x, input.on_border, {}));
  }
};

TEST(ClothBehindAFlatLayer, ThatCrossesTheLayerMovesToItsFront) {
  const ClothOnLayer tilted(0.5, 0.01);
  tilted.with_layer([&](const UntangleInput& input, const ForbiddenRegion& layer) {
    const std::vector<InsideRegion> regions = find_inside(input, layer, tilted.x);
    ASSERT_EQ(regions.size(), 1U);
    EXPECT_EQ(regions[0].moves.size(), 36U) << "four of nine columns are lower than the layer";
    for (const Move& move : regions[0].moves) {
      EXPECT_LT(tilted.x[at(move.particle)].z(), 0);
      EXPECT_GT(move.target.z(), 0);
    }
  });
}

// An example is the back of a coat that is worn over an apron.
TEST(ClothBehindAFlatLayer, ThatIsApartFromTheLayerStays) {
  const ClothOnLayer apart(0, -0.05);
  apart.with_layer([&](const UntangleInput& input, const ForbiddenRegion& layer) {
    EXPECT_TRUE(layer.contains(apart.x[0]));
    EXPECT_TRUE(find_inside(input, layer, apart.x).empty());
  });
}

TEST(ClothBehindAFlatLayer, HasTheDepthOfItsThreads) {
  const ClothOnLayer any(0, 0.01);
  any.with_layer([](const UntangleInput&, const ForbiddenRegion& layer) {
    EXPECT_NEAR(layer.midpoint_depth({-0.1, 0.01, -0.05}, {0.1, 0.02, -0.05}), 0.05 / Vec3(0.2, 0.01, 0).norm(), 1e-12);
    EXPECT_EQ(layer.midpoint_depth({-0.1, 0.01, 0.05}, {0.1, 0.02, 0.05}), 0);
  });
}

// A box without its upper side. Characters have such holes at soles and eyes.
TEST(OpenBody, IsNotLeftThroughItsHole) {
  mesh::Mesh box = mesh::make_box(Vec3(1, 1, 1), 0, 1);
  const auto is_above = [&](Index v) { return box.positions[at(v)].z() > 0; };
  std::erase_if(box.topology.triangles, [&](const mesh::Triangle& t) { return std::ranges::all_of(t, is_above); });
  collision::Bodies bodies;
  bodies.add(box.topology.triangles, static_cast<Index>(box.positions.size()), {.thickness = 0.002});
  const collision::BroadPhase surfaces(bodies.surfaces(), box.positions);
  const ForbiddenRegion region(surfaces, 0, SurfaceKind::solid, box.positions);
  const Vec3 p(0.1, 0.07, 0.13);
  EXPECT_TRUE(region.contains(p));
  EXPECT_NEAR(region.distance_out(p, Vec3::UnitX()), 0.4, 1e-12);
  EXPECT_NEAR(region.distance_out(p, -Vec3::UnitZ()), 0.63, 1e-12);
  EXPECT_EQ(region.distance_out(p, Vec3::UnitZ()), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace weft::untangle
