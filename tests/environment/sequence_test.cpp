// Bodies whose motion is a sequence of mesh files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "film/environment/actor.hpp"
#include "support/test_folder.hpp"

namespace weft::environment {
namespace {

class Sequence : public support::TestFolder {};

// Three files at 10 Hz last 0.2 s.
TEST_F(Sequence, StartsBeforeItsEnd) {
  for (int k = 0; k < 3; ++k)
    support::write_bytes(folder_ / fmt::format("f{}.obj", k),
                         fmt::format("v 0 {0} 0\nv 1 {0} 0\nv 0 {0} 1\nf 1 2 3\n", k));
  scene::Scene scene;
  scene::Character& character = scene.characters.emplace_back();
  character.name = "body";
  character.source = scene::MeshSequence{(folder_ / "f*.obj").string(), 10};
  character.start = 0.2;
  EXPECT_NEAR(make_actor(scene, character).keys.at(0, 0).position.z(), 2, 1e-6);
  character.start = 0.3;
  for (const bool counted : {false, true})
    support::expect_error(ExitCode::scene_invalid,
                          "character.body.start: expected a time of its files, at most 0.2 s, got 0.3", [&] {
                            if (counted)
                              count_key_frames(scene, character);
                            else
                              make_actor(scene, character);
                          });
}

}  // namespace
}  // namespace weft::environment
