// Tests models of some cloths, and bodies that another program moves.
#include "physics/model/model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "film/environment/environment.hpp"
#include "support/scene_runs.hpp"

namespace weft::model {
namespace {

Model model_of(const std::string& text) {
  return environment::Environment(support::scene_of_text(text)).model;
}

const std::string kThree =
    "[[cloth]]\nname = 'a'\nparticles = 3\n[[cloth]]\nname = 'b'\nparticles = 4\nposition = [0, 0, 1]\n"
    "[[cloth]]\nname = 'c'\nparticles = 5\nposition = [0, 0, 2]\n[[obstacle]]\nname = 'ball'\nshape = 'sphere'\n"
    "position = [0, 0, 4]\n"
    "[[attach]]\nname = 'ab'\ncloth = 'a'\nto = 'b'\n[[attach]]\nname = 'ca'\ncloth = 'c'\nto = 'a'\n"
    "[[attach]]\nname = 'cb'\ncloth = 'c'\nto = 'ball'\n";

// `part` contains only the cloths a and c: c has the number 1 in it, and attachments to b are removed.
TEST(Model, WithSomeClothsHasTheirAttachmentsAndTheirNumbers) {
  const Model whole = model_of(kThree);
  ASSERT_EQ(whole.attachments.size(), 3U);
  const Model part = whole.with_cloths(std::array<std::size_t, 2>{0, 2});
  ASSERT_EQ(part.cloths.size(), 2U);
  EXPECT_EQ(part.cloths[1].name, "c");
  EXPECT_EQ(part.bodies.size(), 1U);
  ASSERT_EQ(part.attachments.size(), 2U);
  EXPECT_EQ(part.attachments[0].name, "ca");
  EXPECT_EQ(part.attachments[0].cloth, 1U);
  EXPECT_EQ(part.attachments[0].to_cloth, 0U);
  EXPECT_EQ(part.attachments[1].name, "cb");
  EXPECT_EQ(part.attachments[1].to_body, 0U);
  EXPECT_FALSE(part.attachments[1].to_cloth);
}

TEST(Model, MovesABodyAsItIsTold) {
  Model model = model_of(
      "[[obstacle]]\nname = 'hand'\nshape = 'sphere'\ninterpolation = 'linear'\n"
      "keys = [{ time = 0, position = [1, 0, 0] }, { time = 1, position = [2, 0, 0] }]\n");
  EXPECT_EQ(model.pose(0, 0.5).position, Vec3(1.5, 0, 0));
  const Model before = model;
  model.set_motion(0, {motion::Interpolation::linear, {{0, {{1, 0, 0}}}, {1, {{1, 4, 0}}}}});
  EXPECT_EQ(model.pose(0, 0.5).position, Vec3(1, 2, 0));
  EXPECT_EQ(model.pose(0, 0.5).velocity, Vec3(0, 4, 0));
  EXPECT_EQ(before.pose(0, 0.5).position, Vec3(1.5, 0, 0)) << "a copy keeps the motion";
}

}  // namespace
}  // namespace weft::model
