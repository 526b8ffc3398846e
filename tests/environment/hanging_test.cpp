// Sheets that hang from a part of a character.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "environment/rod_scene.hpp"
#include "film/environment/environment.hpp"
#include "film/environment/wearers.hpp"

namespace weft::environment {
namespace {

class HangingSheets : public RodScene {};

// The rod is 2 m tall, and passes through the middle of a horizontal sheet.
TEST_F(HangingSheets, MoveOffABodyWithoutArmsAndLegs) {
  character_.source = file_;
  scene::Cloth& sheet = scene_.cloths.emplace_back();
  sheet.name = "sheet";
  sheet.size = {1, 1};
  sheet.particles_weft = sheet.particles_warp = 5;
  sheet.pose.position = {0, 0, 1.5};
  sheet.pins.emplace_back().follow = "rod.Spine";
  sheet.start = scene::ClothStart::untangle;
  const double thickness = sheet.material.thickness;
  const Environment environment(scene_);
  for (const Vec3& x : environment.model.cloths[0].start) EXPECT_NEAR(x.z(), 2 + thickness, 1e-6);

  Wearers wearers(scene_);
  wearers.carrier("rod", "here");
  support::expect_error(ExitCode::scene_invalid, "here: expected a wearer that stands upright with two joints UpperLeg",
                        [&] { wearers.of("rod", "here"); });
}

}  // namespace
}  // namespace weft::environment
