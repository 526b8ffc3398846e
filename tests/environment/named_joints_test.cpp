// Joints that the scene names.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "environment/rod_scene.hpp"

namespace weft::environment {
namespace {

class NamedJoints : public RodScene {};

// A node that the scene names as the chest must not stay the spine as well, although its name is common for a spine.
TEST_F(NamedJoints, AreNoOtherJoints) {
  character_.parts.emplace_back().name = "Chest";
  file_.joints = {{"Chest", "Spine", std::nullopt}};
  const Actor actor = make();
  ASSERT_EQ(actor.parts.size(), 1u);
  EXPECT_EQ(std::ranges::count(actor.parts[0].vertices, 1), 3);
}

// A leg whose upper and lower part are one bone has no knee.
TEST_F(NamedJoints, AreDifferentNodes) {
  character_.parts.emplace_back().name = "legs";
  file_.joints = {
      {"Hips", "Hips", std::nullopt}, {"LeftLowerLeg", "Spine", std::nullopt}, {"LeftUpperLeg", "Spine", std::nullopt}};
  support::expect_error(ExitCode::scene_invalid,
                        "character.rod.joint.LeftLowerLeg: expected a node of " + file_.path.string() +
                            " that is no other joint, got \"Spine\", which is LeftUpperLeg too",
                        [&] { make(); });
  file_.joints[1].body = "Hips";  // one node may be the hips and a joint of a leg
  EXPECT_NO_THROW(make());
}

}  // namespace
}  // namespace weft::environment
