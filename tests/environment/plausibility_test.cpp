#include "environment/plausibility.hpp"

#include <gtest/gtest.h>

namespace weft::environment {
namespace {

TEST(Plausibility, DoubtsABodyWhoseBonesHoldNoSkin) {
  // Hips and below them five bones, all of which the clip turns; the mesh hangs on the hips.
  character::Character body;
  body.nodes.push_back({"hips", -1, character::Affine::Identity()});
  character::Clip clip;
  for (Index n = 1; n <= 5; ++n) {
    body.nodes.push_back({"bone", 0, character::Affine::Identity()});
    clip.channels.push_back({n, {}, {{0, 1}, {Quat::Identity(), Quat(0, 1, 0, 0)}}, {}});
  }
  body.bones = {{0, character::Affine::Identity()}, {3, character::Affine::Identity()}};
  body.influences = {{0, 1}, {0, 1}};
  EXPECT_EQ(
      doubt_of_skin(body, clip),
      "has no skin on its bones: node \"hips\" holds all of it, and 5 nodes that the motion turns move nothing of "
      "it; bind the mesh to the skeleton in the program that it is from");
  body.influences[1].bone = 1;
  EXPECT_EQ(doubt_of_skin(body, clip), std::nullopt) << "one limb has a skin";
  body.influences[1].bone = 0;
  clip.channels.resize(3);
  EXPECT_EQ(doubt_of_skin(body, clip), std::nullopt) << "what turns may be something else";
}

}  // namespace
}  // namespace weft::environment
