// The plan of a scene must name the parts that the physics uses for its model.
#include "film/production/plan.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "film/environment/environment.hpp"
#include "physics/simulation/collision_stage.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::production {
namespace {

TEST(Plan, SaysThatAScenesObjectsCanCollideWhereTheyCan) {
  const std::string sheet = "[[cloth]]\nname = 'sheet'\nparticles = 3\n", off = "[contact]\nself = false\n",
                    ball = "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nposition = [0, 0, 2]\n",
                    floor = "[[obstacle]]\nname = 'floor'\nshape = 'plane'\nposition = [0, 0, -3]\n";
  for (const std::string& text :
       {sheet, off + sheet, off + sheet + ball, off + sheet + ball + "collide = false\n",
        "[contact]\nself = false\nobstacles = false\n" + sheet + ball, ball, floor + ball, floor + ball + "mass = 1\n",
        floor + ball + "mass = 1\ncollide = false\n", std::string("[contact]\nobstacles = false\n") + ball}) {
    const scene::Scene scene = support::scene_of_text(text);
    EXPECT_EQ(can_collide(scene), simulation::CollisionStage::is_needed(environment::Environment(scene).model)) << text;
  }
}

TEST(Plan, BlamesNoKeyOfContactOrMaterialInASceneWithoutCloth) {
  const scene::Scene scene = support::scene_of_text(
      "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nposition = [0, 0, 2]\n"
      "[[obstacle]]\nname = 'floor'\nshape = 'plane'\n");
  std::map<std::string, std::string> reasons;
  for (const PlanItem& item : plan(scene)) reasons[item.part] = item.reason;
  EXPECT_EQ(reasons.at("collision: cloth and obstacles"), "no cloth, and forces move no obstacle that collides");
  EXPECT_EQ(reasons.at("collision: velocity constraints"), "no cloth, and forces move no obstacle that collides");
  EXPECT_EQ(reasons.at("collision: cloth and cloth"), "no cloth");
  EXPECT_EQ(reasons.at("force: bending"), "no cloth");
}

TEST(Plan, UsesGravityOfKeysInPlaceOfTheConstantOne) {
  const auto gravity = [](const std::string& physics) {
    for (const PlanItem& item :
         plan(support::scene_of_text("[[obstacle]]\nname = 'ball'\nshape = 'sphere'\n[physics]\n" + physics)))
      if (item.part == "force: gravity") return std::string(item.used ? "uses " : "leaves out ") + item.reason;
    return std::string();
  };
  EXPECT_EQ(gravity("gravity = [0, 0, -4]\n"), "uses 4 m/s²");
  EXPECT_EQ(gravity("gravity = [0, 0, 0]\n"), "leaves out physics.gravity is zero");
  EXPECT_EQ(
      gravity("gravity = [0, 0, 0]\nkeys = [{ time = 0, gravity = [0, 0, 0] }, { time = 1, gravity = [0, 0, -9] }]\n"),
      "uses at most 9 m/s²");
  EXPECT_EQ(gravity("keys = [{ time = 0, gravity = [0, 0, 0] }]\n"), "leaves out gravity of physics.keys is zero");
}

using Plans = support::TestFolder;

TEST_F(Plans, CountTheVerticesOfAllFilesOfASequence) {
  const auto fold = [](double y) {  // two triangles, of which two corners coincide if y is 0
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 " + std::to_string(y) + " 0\nf 1 2 3\nf 1 4 3\n";
  };
  support::write_bytes(folder_ / "0.obj", fold(0));
  support::write_bytes(folder_ / "1.obj", fold(1));
  std::map<std::string, std::string> reasons;
  for (const PlanItem& item : plan(support::scene_of_text(
           "[[character]]\nname = 'fold'\nsource = 'sequence'\nfiles = '" + folder_.string() + "'\n")))
    reasons[item.part] = item.reason;
  EXPECT_NE(reasons.at("motion: character fold").find("of 4 vertices"), std::string::npos)
      << reasons.at("motion: character fold");
}

TEST(Warnings, NamePinsOfRopesByTheirKeys) {
  const std::string ball = "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nradius = 0.1\n";
  const auto warnings_of = [&](const std::string& pin) {
    return find_warnings(support::scene_of_text(
        "[[rope]]\nname = 'line'\nfrom = [0, 0, 1]\nto = [1, 0, 1]\n[[rope.pin]]\nat = 0\n" + pin + ball));
  };
  const auto jump = warnings_of("keys = [{ time = 0, offset = [0.2, 0, 0] }]\n"),
             far = warnings_of("follow = 'ball'\n");
  ASSERT_EQ(jump.size(), 1U);
  EXPECT_TRUE(jump[0].starts_with("rope.line.pin.0: its keys begin 0.2 m away")) << jump[0];
  ASSERT_EQ(far.size(), 1U);
  EXPECT_TRUE(far[0].starts_with("rope.line.pin.0: follows 'ball' from 0.9 m away")) << far[0];
}

TEST(Warnings, NameInfinitePlanesThatPicturesDoNotShow) {
  const std::string floor = "[[obstacle]]\nname = 'floor'\nshape = 'plane'\n",
                    wall = "[[obstacle]]\nname = 'wall'\nshape = 'plane'\nrotation = [90, 0, 0]\n";
  const std::vector<std::string> found = find_warnings(support::scene_of_text(floor + wall));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("obstacle.wall: pictures show only one infinite plane, 'floor'")) << found[0];
  for (const char* key : {"infinite = false\n", "look.visible = false\n"})
    EXPECT_TRUE(find_warnings(support::scene_of_text(floor + wall + key)).empty()) << key;
}

TEST(Warnings, NameLightsThatPicturesDoNotShow) {
  std::string lights = "[[obstacle]]\nname = 'floor'\nshape = 'plane'\n";
  for (const char* name : {"a", "b", "c", "d"}) lights += std::string("[[light]]\nname = '") + name + "'\n";
  EXPECT_TRUE(find_warnings(support::scene_of_text(lights)).empty());
  const std::vector<std::string> found = find_warnings(support::scene_of_text(lights + "[[light]]\nname = 'e'\n"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].starts_with("light.e: has no effect")) << found[0];
}

}  // namespace
}  // namespace weft::production
