// Joints that the scene names.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "film/environment/actor.hpp"
#include "support/small_character.hpp"
#include "support/test_folder.hpp"

namespace weft::environment {
namespace {

class NamedJoints : public support::TestFolder {};

// A node that the scene names as the chest must not stay the spine as well, although its name is common for a spine.
TEST_F(NamedJoints, AreNoOtherJoints) {
  support::write_bytes(folder_ / "rod.x", support::rod_file());
  scene::Scene scene;
  scene::Character& character = scene.characters.emplace_back();
  character.name = "rod";
  character.parts.emplace_back().name = "Chest";
  scene::CharacterFile file;
  file.path = folder_ / "rod.x";
  file.joints = {{"Chest", "Spine", std::nullopt}};
  character.source = file;
  const Actor actor = make_actor(scene, character);
  ASSERT_EQ(actor.parts.size(), 1u);
  EXPECT_EQ(std::ranges::count(actor.parts[0].vertices, 1), 3);
}

// A leg whose upper and lower part are one bone has no knee.
TEST_F(NamedJoints, AreDifferentNodes) {
  support::write_bytes(folder_ / "rod.x", support::rod_file());
  scene::Scene scene;
  scene::Character& character = scene.characters.emplace_back();
  character.name = "rod";
  character.parts.emplace_back().name = "legs";
  scene::CharacterFile file;
  file.path = folder_ / "rod.x";
  file.joints = {
      {"Hips", "Hips", std::nullopt}, {"LeftLowerLeg", "Spine", std::nullopt}, {"LeftUpperLeg", "Spine", std::nullopt}};
  character.source = file;
  support::expect_error(ExitCode::scene_invalid,
                        "character.rod.joint.LeftLowerLeg: expected a node of " + file.path.string() +
                            " that is no other joint, got \"Spine\", which is LeftUpperLeg too",
                        [&] { make_actor(scene, character); });
  file.joints[1].body = "Hips";  // one node may be the hips and a joint of a leg
  character.source = file;
  EXPECT_NO_THROW(make_actor(scene, character));
}

}  // namespace
}  // namespace weft::environment
