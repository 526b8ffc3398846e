// Simulated laboratory tests recover the parameters of a fabric; cusick_slow.cpp tests how all fabrics drape.
#include <gtest/gtest.h>

#include "film/scene/fabrics.hpp"
#include "lab/bench/fabric_tests.hpp"

namespace weft::bench {
namespace {

TEST(CantileverOfAFabric, FindsItsRigidityAndMoreWithItsFriction) {
  scene::Material wool = scene::find_fabric("wool")->material;
  const double with_friction = cantilever(wool).rigidity;
  wool.bend_friction = 0;
  // Measured deviation: 0.2 %, from the accuracy of the overhang (1e-3) and the discretisation (40 cells).
  EXPECT_NEAR(cantilever(wool).rigidity, wool.bend, 0.01 * wool.bend);
  // Measured: friction raises the result by 18 %. Laboratories, too, measure more by cantilever than by KES.
  EXPECT_GT(with_friction, 1.1 * wool.bend);
}

TEST(StripOfAFabric, StretchesAtTheLoadsOfFastAndKesAsThoseSay) {
  for (const char* name : {"cotton", "wool", "jersey", "leather"}) {
    const scene::Fabric& fabric = *scene::find_fabric(name);
    const scene::Measurements& m = fabric.measured;
    const double weft = extension(fabric.material, Direction::weft, scene::kExtensionLoad),
                 warp = extension(fabric.material, Direction::warp, scene::kExtensionLoad);
    // Fabrics have one stretch limit for both directions, so only the mean is compared. Tolerance: stiffness and limit
    // are stored with two digits, which changes the extension by up to 2 %.
    const double mean = 0.5 * (m.extension_weft.value + m.extension_warp.value);
    EXPECT_NEAR(0.5 * (weft + warp), mean, 0.03 * mean) << name;
    const double worn = extension(fabric.material, Direction::warp, scene::kWornLoad);
    // Tolerance: the strip's own weight, half of which pulls at the middle, adds up to 2.5 %.
    EXPECT_NEAR(worn, scene::kWornLoad / fabric.material.stretch_warp, 0.03 * worn) << name;
  }
}

}  // namespace
}  // namespace weft::bench
