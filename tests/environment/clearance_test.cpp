// Nearness of skin to cloth, which decides where a body needs clearance.
#include "film/environment/clearance.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace weft::environment {
namespace {

// The cloth is one triangle of a metre; the tested places are far from its corners.
TEST(Clearance, NearnessIsThatToTheSurfaceNotToItsParticles) {
  const std::vector<Vec3> cloth{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const std::vector<mesh::Triangle> triangles{{0, 1, 2}};
  const std::vector<Vec3> skin{{0.3, 0.3, 1}, {0.3, 0.3, 1.02}, {0.3, 0.3, 0.96}, {0.3, 0.3, 0.94}, {0.3, 0.3, 3}};
  const std::vector<float> near_cloth = nearness_of_cloth(skin, {cloth, triangles, 0});
  EXPECT_EQ(near_cloth[0], 1);
  EXPECT_EQ(near_cloth[1], 1) << "up to half of 5 cm";
  // Tolerance: samples of the cloth are 2 cm apart, so a distance of 40 mm may be found as up to 42 mm.
  EXPECT_NEAR(near_cloth[2], 0.4, 0.08);
  EXPECT_EQ(near_cloth[3], 0) << "6 cm";
  EXPECT_EQ(near_cloth[4], 0);
}

TEST(Clearance, WithoutClothNothingIsNear) {
  EXPECT_EQ(nearness_of_cloth(std::vector<Vec3>{{0, 0, 0}}, {{}, {}, 0}), std::vector<float>{0});
}

}  // namespace
}  // namespace weft::environment
