// Velocity cones against the motions they are made of.
#include "collision/hierarchy/velocity_cone.hpp"

#include <gtest/gtest.h>

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
  const Vec3 common = scale * random_vec(generator);
  VelocityCone half;
  for (int i = 0; i < 20; ++i) {
    motions.each.push_back(common + scale * spread * random_vec(generator));
    // Half of them one by one, half as a cone of their own.
    (i % 2 == 0 ? motions.cone : half).join(VelocityCone(motions.each.back()));
  }
  motions.cone.join(half);
  return motions;
}

TEST(VelocityCone, HoldsEachMotionAndBoundsEachRelativeMotion) {
  std::mt19937 generator(2);
  for (int i = 0; i < 500; ++i) {
    const double scale = std::pow(10.0, i % 9 - 6);
    const Motions a = random_motions(generator, scale, i % 3 == 0 ? 1 : 0.1), b = random_motions(generator, scale, 0.3);
    double most = 0;
    for (const Vec3& u : a.each) {
      EXPECT_LE((u - a.cone.mean()).norm(), a.cone.radius() * (1 + 1e-12));
      EXPECT_LE(u.norm(), a.cone.size());
      const double cosine = std::clamp(u.dot(a.cone.direction()) / u.norm(), -1.0, 1.0);
      EXPECT_LE(std::acos(cosine), a.cone.half_angle() + 1e-6);
      for (const Vec3& v : b.each) most = std::max(most, (u - v).norm());
    }
    EXPECT_LE(most, relative_motion(a.cone, b.cone));
    EXPECT_GE(most, 0.3 * relative_motion(a.cone, b.cone)) << "the bound is of no use";
  }
}

TEST(VelocityCone, OfEqualTranslationsHasNoAngleAndNoRelativeMotion) {
  VelocityCone a(Vec3(3, 4, 0)), b(Vec3(3, 4, 0));
  a.join(b);
  EXPECT_EQ(relative_motion(a, b), 0);
  EXPECT_EQ(a.half_angle(), 0);
  EXPECT_NEAR(a.size(), 5, 1e-12);
}

}  // namespace
}  // namespace weft::collision
