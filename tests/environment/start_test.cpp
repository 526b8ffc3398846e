// Start shapes that are scaled or randomly perturbed.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "film/environment/environment.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::environment {
namespace {

scene::Scene turned_sheet() {
  scene::Scene scene;
  scene::Cloth cloth;
  cloth.name = "sheet";
  cloth.size = {1, 2};
  cloth.particles_weft = 5;
  cloth.particles_warp = 9;
  cloth.pose.position = {1, 2, 3};
  cloth.pose.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
  scene.cloths.push_back(cloth);
  return scene;
}

TEST(Start, ScaleStretchesAlongWeftAndWarpAboutTheMiddleAndLeavesTheRestShape) {
  const Environment at_rest(turned_sheet());
  scene::Scene scene = turned_sheet();
  scene.cloths[0].start_scale = {3, 0.25};
  const Environment scaled(scene);
  EXPECT_EQ(scaled.model.cloths[0].mesh.positions, at_rest.model.cloths[0].mesh.positions);
  const auto& x = scaled.model.cloths[0].start;
  EXPECT_NEAR((x[4] - x[0]).norm(), 3 * 1, 1e-12);
  EXPECT_NEAR((x[40] - x[0]).norm(), 0.25 * 2, 1e-12);
  EXPECT_LT((x[22] - Vec3(1, 2, 3)).norm(), 1e-12);  // the middle of the sheet stays at its place
}

TEST(Start, ScaleStretchesPatternsAcrossAndAlongTheUpAxis) {
  scene::Scene scene = turned_sheet();
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = scene::ClothShape::pattern;
  cloth.file = std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/pillow.toml";
  cloth.edge_length = 0.1;
  cloth.pose.rotation = Quat::Identity();
  for (const auto up : {scene::UpAxis::z, scene::UpAxis::y}) {
    scene.up = up;
    cloth.start_scale = {1, 1};
    const Vec3 size = mesh::bounding_box(Environment(scene).model.cloths[0].start).sizes();
    cloth.start_scale = {3, 0.5};
    const Vec3 scaled = mesh::bounding_box(Environment(scene).model.cloths[0].start).sizes();
    const int warp = up == scene::UpAxis::z ? 2 : 1;
    EXPECT_NEAR(scaled.x(), 3 * size.x(), 1e-12);
    EXPECT_NEAR(scaled[warp], 0.5 * size[warp], 1e-12);
    EXPECT_NEAR(scaled[3 - warp], size[3 - warp], 1e-12);
  }
}

TEST(Start, NoiseIsBoundedDifferentForEachParticleAndTheSameInEveryRun) {
  scene::Scene scene = turned_sheet();
  const Environment at_rest(scene);
  scene.cloths[0].start_noise = 0.01;
  const Environment shaken(scene), again(scene);
  const auto &x = shaken.model.cloths[0].start, &rest = at_rest.model.cloths[0].start;
  EXPECT_EQ(x, again.model.cloths[0].start);
  std::set<double> offsets;
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      offsets.insert(x[i][axis] - rest[i][axis]);
      most = std::max(most, std::abs(x[i][axis] - rest[i][axis]));
    }
  EXPECT_EQ(offsets.size(), 3 * x.size());
  EXPECT_LE(most, 0.01);
  EXPECT_GT(most, 0.009);  // the largest of 135 uniform numbers in ±0.01 is less with a probability of 7e-7
}

}  // namespace
}  // namespace weft::environment
