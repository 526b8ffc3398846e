// The tests of the laboratory find in a fabric what it is made of; how all fabrics drape: cusick_slow.cpp.
#include <gtest/gtest.h>

#include "bench/fabric_tests.hpp"
#include "scene/fabrics.hpp"

namespace weft::bench {
namespace {

TEST(CantileverOfAFabric, FindsItsRigidityAndMoreWithItsFriction) {
  scene::Material wool = scene::find_fabric("wool")->material;
  const double with_friction = cantilever(wool).rigidity;
  wool.bend_friction = 0;
  // 0.2 % off: the overhang is found to 1e-3, the strip has 40 cells.
  EXPECT_NEAR(cantilever(wool).rigidity, wool.bend, 0.01 * wool.bend);
  // 18 % more: laboratories measure more by cantilever than by KES, too.
  EXPECT_GT(with_friction, 1.1 * wool.bend);
}

TEST(StripOfAFabric, StretchesAtTheLoadsOfFastAndKesAsThoseSay) {
  for (const char* name : {"cotton", "wool", "jersey", "leather"}) {
    const scene::Fabric& fabric = *scene::find_fabric(name);
    const scene::Measurements& m = fabric.measured;
    const double weft = extension(fabric.material, Direction::weft, scene::kExtensionLoad),
                 warp = extension(fabric.material, Direction::warp, scene::kExtensionLoad);
    // One limit for both directions. Stretch and limit have two digits, 2 % off at most.
    const double mean = 0.5 * (m.extension_weft.value + m.extension_warp.value);
    EXPECT_NEAR(0.5 * (weft + warp), mean, 0.03 * mean) << name;
    const double worn = extension(fabric.material, Direction::warp, scene::kWornLoad);
    // Its own weight, half of which pulls at the middle, adds up to 2.5 %.
    EXPECT_NEAR(worn, scene::kWornLoad / fabric.material.stretch_warp, 0.03 * worn) << name;
  }
}

}  // namespace
}  // namespace weft::bench
