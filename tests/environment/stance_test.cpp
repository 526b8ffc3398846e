// Characters that stand in another pose than their clip begins with.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "environment/rod_scene.hpp"

namespace weft::environment {
namespace {

class Stance : public RodScene {};

// The clip has one pose and thus no rate of keys. The body must still get several keys.
TEST_F(Stance, BodyAtRestChangesToAClipOfOnePose) {
  support::write_bytes(file_.path,
                       support::replaced(support::rod_file(), "2; 2; 0;3;0.0,1.0,0.0;;, 10;3;1.0,1.0,0.0;;;",
                                         "2; 1; 0;3;1.0,1.0,0.0;;;"));
  scene_.time.duration = 2;
  character_.dressing = 0.5;
  character_.blend = 0.5;
  file_.clip = "Wave";
  file_.stance = scene::Stance::rest;
  const Actor actor = make();
  const auto moved = [&](double t) {
    std::vector<Vec3> x(actor.mesh.positions.size());
    actor.keys.at(t, x);
    double most = 0;
    for (std::size_t v = 0; v < x.size(); ++v) most = std::max(most, (x[v] - actor.mesh.positions[v]).norm());
    return most;
  };
  EXPECT_LT(moved(0.48), 1e-6);
  EXPECT_NEAR(moved(0.75), 0.5, 0.02) << "half of the change";
  EXPECT_NEAR(moved(1.5), 1, 1e-5);
  EXPECT_EQ(count_key_frames(scene_, character_).bytes, actor.keys.bytes());
}

// With a repeated clip, the stance must have the pose at the start of the round in which the clip begins, not at the
// end of the clip, 1 m higher.
TEST_F(Stance, WithRaisedArmsHasThePoseOfTheRoundInWhichTheClipStarts) {
  support::write_bytes(file_.path,  // moves up by 1 m
                       support::replaced(support::rod_file(), "10;3;1.0,1.0,0.0", "10;3;0.0,2.0,0.0"));
  scene_.time.duration = 2;
  character_.start = 1.5;
  character_.dressing = 0.5;
  character_.blend = 0.5;
  file_.clip = "Wave";
  file_.loop = true;
  file_.stance_arms = 45;
  const Actor actor = make();
  double top = 0;
  for (const Vec3& x : actor.mesh.positions) top = std::max(top, x.z());
  EXPECT_NEAR(top, 2.5, 1e-5) << "half of the second round";
}

}  // namespace
}  // namespace weft::environment
