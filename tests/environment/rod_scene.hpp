// A scene whose only character is the rod of support::rod_file().
#pragma once

#include <span>

#include "film/environment/actor.hpp"
#include "support/small_character.hpp"
#include "support/test_folder.hpp"

namespace weft::environment {

class RodScene : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    file_.path = folder_ / "rod.x";
    support::write_bytes(file_.path, support::rod_file());
    scene_.file = "scenes/a.toml";
    character_.name = "rod";
  }

  /// Makes the character from `file_`.
  Actor make(std::span<const FollowerPoints> following = {}) {
    character_.source = file_;
    return make_actor(scene_, character_, following);
  }

  scene::Scene scene_;
  scene::Character& character_ = scene_.characters.emplace_back();
  scene::CharacterFile file_;
};

}  // namespace weft::environment
