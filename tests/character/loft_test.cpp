#include "film/character/loft.hpp"

#include <gtest/gtest.h>

#include <array>

namespace weft::character {
namespace {

Loft ball(const Vec3& middle, double radius) {
  return Loft({middle}, {{0, 0, 0, radius, 0.5 * radius, radius, 2}}, radius, radius);
}

// Groups skip parts that have no effect. Some points lie on the bounds of groups, and inside of carved parts.
TEST(BlendedBody, IsTheSameFieldInGroupsToTheBit) {
  std::array<BlendedBody, 2> bodies;
  for (BlendedBody& body : bodies) {
    const auto begin_group = [&] {
      if (&body == &bodies[1]) body.begin_group();
    };
    body.add(ball({0, 0, 0}, 0.3), 0.05, false);
    body.add(ball({0.2, 0, 0.1}, 0.2), 0.06, true);
    begin_group();
    body.add(ball({0, 0, 0.9}, 0.2), 0.1, false);
    body.carve(ball({0.1, 0.1, 0.9}, 0.1), 0.02, true);
    begin_group();
    begin_group();
    body.add(ball({0.8, 0, 0}, 0.1), 0.3, true);
  }
  constexpr int kSteps = 24;
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; j += 4)
      for (int k = -kSteps; k <= kSteps; ++k) {
        const Vec3 p = 0.05 * Vec3(i, j, k);
        EXPECT_EQ(bodies[0](p), bodies[1](p)) << p.transpose();
      }
}

}  // namespace
}  // namespace weft::character
