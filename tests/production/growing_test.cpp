// Bodies that garments do not fit at the start: wearers that grow into their patterns, and capes that move off a back.
#include "film/environment/growing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/log.hpp"
#include "film/environment/environment.hpp"
#include "film/production/scene_simulation.hpp"
#include "physics/mesh/geometry.hpp"
#include "support/intersections.hpp"
#include "support/scene_runs.hpp"

namespace weft::production {
namespace {

scene::Scene dressed_mannequin(const std::string& character, const std::string& cloth) {
  return support::scene_of_text(
      "[time]\nduration = 0.2\npreroll = 0.4\n[[character]]\nname = \"model\"\n"
      "source = \"mannequin\"\nedge_length = 0.05\n" +
      character + "[[cloth]]\nname = \"cloth\"\n" + cloth);
}

std::string pattern(const std::string& name) {
  return "shape = \"pattern\"\nedge_length = 0.06\nfile = \"" + std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" +
         name + "\"\n";
}

std::size_t crossing_pairs(const frame::FrameSnapshot& snapshot) {
  return support::find_intersections(support::objects_of(snapshot)).pairs.size();
}

/// Notes that `action` causes.
template <class Action>
std::vector<std::string> notes_of(const Action& action) {
  std::vector<std::string> notes;
  log::set_handler([&](std::string_view text) { notes.emplace_back(text); });
  EXPECT_NO_THROW(action());
  log::set_handler({});
  return notes;
}

// At the start, the arms hang through the wall of the skirt.
TEST(Growing, ArmsThatCrossASkirtAreHeldOffIt) {
  const scene::Scene scene = dressed_mannequin("dressing = 0.2\nblend = 0.1\nwalk = 1\n", pattern("skirt.toml"));
  const auto posed = environment::pose_arms_for_sleeves(scene, environment::Environment(scene));
  ASSERT_TRUE(posed);
  EXPECT_EQ(scene::skeleton_motion_of(posed->characters[0])->stance_arms.value_or(0), 45);
  EXPECT_EQ(crossing_pairs(*production::view_start(*posed).snapshot), 0U);
}

// The arms cross both the shirt and the skirt. Only the sleeves determine where the arms can be.
TEST(Growing, ArmsThatCrossAShirtAndASkirtAreInTheSleeves) {
  const std::string shirt = pattern("tshirt.toml"), skirt = "[[cloth]]\nname = \"skirt\"\n" + pattern("skirt.toml");
  for (const std::string& cloths : {shirt + skirt, pattern("skirt.toml") + "[[cloth]]\nname = \"shirt\"\n" + shirt}) {
    const scene::Scene scene = dressed_mannequin("dressing = 0.2\nblend = 0.1\nwalk = 1\n", cloths);
    const auto posed = environment::pose_arms_for_sleeves(scene, environment::Environment(scene));
    ASSERT_TRUE(posed);
    EXPECT_NEAR(scene::skeleton_motion_of(posed->characters[0])->stance_arms.value_or(0), 57, 10) << cloths;
  }
}

TEST(Growing, ABodyThatAGarmentCannotBeMovedOutOfGrowsIntoIt) {
  const scene::Scene scene = dressed_mannequin("dressing = 0.2\nblend = 0.1\nwalk = 1\ngirth = 1.2\nstance_arms = 57\n",
                                               pattern("tshirt.toml") + "scale = 0.75\nposition = [0, 0, 0.4]\n");
  const auto notes = notes_of([&] {
    const SceneSimulation simulation(scene);
    EXPECT_EQ(crossing_pairs(*simulation.snapshot()), 0U);
  });
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
    return note.find("the body grows into it in the first 0.1 s of dressing, as with grow = 0.1") != std::string::npos;
  })) << (notes.empty() ? "no notes" : notes.back());
}

// The sleeves of the shirt point down by 33 degrees: arms in the sleeves are 57 degrees from hanging down.
TEST(Growing, AWearerGrowsWithItsArmsInTheSleeves) {
  const scene::Scene scene = dressed_mannequin("dressing = 0.2\nblend = 0.1\nwalk = 1\n", pattern("tshirt.toml"));
  std::vector<std::string> notes;
  const auto growing = environment::let_wearers_grow(scene, environment::Environment(scene), notes);
  ASSERT_TRUE(growing);
  EXPECT_EQ(growing->characters[0].grow, 0.1);
  EXPECT_NEAR(scene::skeleton_motion_of(growing->characters[0])->stance_arms.value_or(0), 57, 10);
}

// The wearer and its garment are valid; a second cloth touches a ball.
TEST(Growing, IsNotSaidIfOtherClothIsRefused) {
  const scene::Scene scene = dressed_mannequin(
      "dressing = 0.2\nblend = 0.1\nwalk = 1\nstance_arms = 57\n",
      pattern("skirt.toml") + "[[cloth]]\nname = \"sheet\"\nsize = 0.2\nparticles = 5\nposition = [3, 0, 1]\n" +
          "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.1\nposition = [3, 0, 1]\n");
  std::vector<std::string> notes;
  log::set_handler([&](std::string_view text) { notes.emplace_back(text); });
  EXPECT_THROW(SceneSimulation{scene}, Error);
  log::set_handler({});
  for (const std::string& note : notes) EXPECT_EQ(note.find("the body grows into it"), std::string::npos) << note;
}

// Without `dressing`, the viewer would see the body grow.
TEST(Growing, NoWearerGrowsWithoutTimeForIt) {
  const scene::Scene scene = dressed_mannequin("walk = 1\n", pattern("tshirt.toml"));
  std::vector<std::string> notes;
  EXPECT_FALSE(environment::let_wearers_grow(scene, environment::Environment(scene), notes));
}

TEST(Growing, AGarmentThatIsFittedStartsWhereItsWearerStands) {
  const auto middle_of = [](const std::string& character) {
    const scene::Scene scene = dressed_mannequin(character, pattern("tshirt.toml") + "fit = true\n");
    return mesh::bounding_box(environment::Environment(scene).model.cloths[0].start);
  };
  const Box3 here = middle_of(""), there = middle_of("position = [2, 1, 0.3]\nrotation = [0, 0, 90]\n");
  EXPECT_LT((there.center() - Vec3(2 - here.center().y(), 1 + here.center().x(), 0.3 + here.center().z())).norm(),
            1e-6);
  EXPECT_NEAR(there.sizes().y(), here.sizes().x(), 1e-6);
}

TEST(Hanging, AnUntangledCapeInABackMovesBehindItWithItsPins) {
  const std::string cape =
      "size = [0.36, 0.8]\nparticles = [10, 20]\nposition = [0, 0.05, 0.98]\nrotation = [90, 0, 180]\n"
      "pin = [{ low = [0, 1], high = [1, 1], follow = \"model.torso\" }]\n";
  const SceneSimulation simulation(dressed_mannequin("", cape + "start = \"untangle\"\n"));
  EXPECT_EQ(crossing_pairs(*simulation.snapshot()), 0U);
  const environment::Environment moved(dressed_mannequin("", cape + "start = \"untangle\"\n"));
  const environment::Environment given(dressed_mannequin("", cape));
  const Vec3 shift = moved.model.cloths[0].start[0] - given.model.cloths[0].start[0];
  EXPECT_GT(shift.y(), 0.03);
  EXPECT_LT(shift.y(), 0.15);
  EXPECT_LT(shift.head<1>().norm() + std::abs(shift.z()), 1e-12);
}

}  // namespace
}  // namespace weft::production
