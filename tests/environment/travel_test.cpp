// The travel of bodies without legs, and of bodies without a motion.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "environment/rod_scene.hpp"

namespace weft::environment {
namespace {

class TravelOfAMotion : public RodScene {};

/// A skeleton of hips, spine and left leg, which stands still.
std::string one_leg() {
  const std::string turns = "CHANNELS 3 Zrotation Yrotation Xrotation\n",
                    zeros = "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n";
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
         "Xrotation\nJOINT Spine\n{\nOFFSET 0 5 0\n" +
         turns + "End Site\n{\nOFFSET 0 5 0\n}\n}\nJOINT LeftUpperLeg\n{\nOFFSET 1 0 0\n" + turns +
         "JOINT LeftLowerLeg\n{\nOFFSET 0 -4 0\n" + turns + "JOINT LeftFoot\n{\nOFFSET 0 -4 0\n" + turns +
         "End Site\n{\nOFFSET 0 0 1\n}\n}\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 1\n" + zeros + zeros;
}

// Without legs, the ratio of leg lengths is undefined. The distance from hips to spine replaces it: 1 m in the body, 5
// in the motion. The travel of the clip at this speed and that of the body must be scaled alike.
TEST_F(TravelOfAMotion, MovesABodyWithoutLegs) {
  support::write_bytes(folder_ / "stand.bvh", one_leg());
  scene_.time.duration = 2;
  file_.motion = folder_ / "stand.bvh";
  file_.travel = {scene::Travel::Kind::speed, 1.5};
  const Actor actor = make();
  std::vector<Vec3> start(actor.mesh.positions.size()), end(start.size());
  actor.keys.at(0, start);
  actor.keys.at(1, end);
  EXPECT_NEAR((end[0] - start[0]).norm(), 1.5, 1e-3);
}

TEST_F(TravelOfAMotion, NeedsAClip) {
  file_.path = folder_ / "statue.obj";
  support::write_bytes(file_.path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  file_.travel = {scene::Travel::Kind::speed, 1.5};
  const std::vector<std::string> warnings = make().warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("has no clip that could travel; it stands still"), std::string::npos) << warnings[0];
}

}  // namespace
}  // namespace weft::environment
