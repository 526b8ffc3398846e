// Compares velocity cones with the motions that they enclose.
#include "physics/collision/variants/velocity_cone.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/hierarchy/test_meshes.hpp"

namespace weft::collision {
namespace {

using testing::random_vec;

struct Motions {
  std::vector<Vec3> each;
  VelocityCone cone;
};

Motions random_motions(std::mt19937& generator, double scale, double spread) {
  Motions motions;
  motions.cone.mean = scale * random_vec(generator);
  for (int i = 0; i < 20; ++i) {
    const Vec3 own = scale * spread * random_vec(generator);
    motions.each.push_back(motions.cone.mean + own);
    motions.cone.radius = std::max(motions.cone.radius, own.norm());
  }
  return motions;
}

TEST(VelocityCone, BoundsEachRelativeMotionOfTwoSets) {
  std::mt19937 generator(2);
  for (int i = 0; i < 500; ++i) {
    const double scale = std::pow(10.0, i % 9 - 6);
    const Motions a = random_motions(generator, scale, i % 3 == 0 ? 1 : 0.1), b = random_motions(generator, scale, 0.3);
    double max_speed = 0;
    for (const Vec3& u : a.each)
      for (const Vec3& v : b.each) max_speed = std::max(max_speed, (u - v).norm());
    EXPECT_LE(max_speed, relative_motion(a.cone, b.cone));
    EXPECT_GE(max_speed, 0.3 * relative_motion(a.cone, b.cone)) << "the bound is of no use";
  }
}

TEST(VelocityCone, OfWhatIsAddedHoldsTheDifferenceOfEachMotion) {
  std::mt19937 generator(3);
  for (int i = 0; i < 500; ++i) {
    const Motions then = random_motions(generator, 1, 0.2), now = random_motions(generator, 2, 0.3);
    const VelocityCone since = now.cone - then.cone;
    for (std::size_t k = 0; k < now.each.size(); ++k)
      EXPECT_LE((now.each[k] - then.each[k] - since.mean).norm(), since.radius * (1 + 1e-12));
  }
}

TEST(VelocityCone, OfEqualTranslationsHaveNoRelativeMotion) {
  const VelocityCone a{Vec3(3, 4, 0), 0}, b{Vec3(3, 4, 0), 0};
  EXPECT_EQ(relative_motion(a, b), 0);
}

}  // namespace
}  // namespace weft::collision
