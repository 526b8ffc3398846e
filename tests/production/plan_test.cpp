// The plan says of a scene what the physics finds in its model.
#include "film/production/plan.hpp"

#include <gtest/gtest.h>

#include <string>

#include "film/environment/environment.hpp"
#include "physics/simulation/collision_stage.hpp"
#include "support/scene_runs.hpp"

namespace weft::production {
namespace {

TEST(Plan, SaysThatAScenesObjectsCanCollideWhereTheyCan) {
  const std::string sheet = "[[cloth]]\nname = 'sheet'\nparticles = 3\n", off = "[contact]\nself = false\n",
                    ball = "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nposition = [0, 0, 2]\n",
                    floor = "[[obstacle]]\nname = 'floor'\nshape = 'plane'\nposition = [0, 0, -3]\n";
  for (const std::string& text : {sheet, off + sheet, off + sheet + ball, off + sheet + ball + "collide = false\n",
                                  "[contact]\nself = false\nobstacles = false\n" + sheet + ball, ball, floor + ball,
                                  floor + ball + "mass = 1\n", std::string("[contact]\nobstacles = false\n") + ball}) {
    const scene::Scene scene = support::scene_of_text(text);
    EXPECT_EQ(can_collide(scene), simulation::CollisionStage::needed(environment::Environment(scene).model)) << text;
  }
}

}  // namespace
}  // namespace weft::production
