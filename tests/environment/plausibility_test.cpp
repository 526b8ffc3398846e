#include "film/environment/plausibility.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace weft::environment {
namespace {

TEST(Plausibility, WarnsOfABodyWhoseBonesHoldNoSkin) {
  // Hips with five child bones that the clip rotates; but the mesh is bound only to the hips.
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
      warn_of_missing_skin(body, clip),
      "has no skin on its bones: node \"hips\" holds all of it, and 5 nodes that the motion turns move nothing of "
      "it; bind the mesh to the skeleton in the program that it is from");
  body.influences[1].bone = 1;
  EXPECT_EQ(warn_of_missing_skin(body, clip), std::nullopt) << "one limb has a skin";
  body.influences[1].bone = 0;
  clip.channels.resize(3);
  EXPECT_EQ(warn_of_missing_skin(body, clip), std::nullopt) << "what turns may be something else";
}

// A jumping body is in the air most of the time; a rolling body is below the floor part of the time. Neither is a
// reason to warn.
TEST(Plausibility, WarnsOfABodyBelowTheFloorHalfOfTheTimeOrAlwaysAboveIt) {
  const auto warning_of = [](std::vector<double> lowest, bool alone = true) {
    return warn_of_floor_distance(std::move(lowest), alone).value_or("");
  };
  EXPECT_EQ(warning_of({}), "");
  EXPECT_EQ(warning_of({-0.3, 0, 0.6, -0.3, 0.6}), "") << "two of five below";
  EXPECT_EQ(warning_of({-0.3, 0, -0.2, -0.4, 0.6}),
            "its lowest point is 0.2 m below the floor in half of its motion or more; position puts it higher");
  EXPECT_EQ(warning_of({0.6, 0.04, 0.6}), "") << "on it once";
  EXPECT_EQ(warning_of({0.6, 0.06, 0.6}), "it comes no nearer to the floor than 0.06 m; position puts it lower");
  EXPECT_EQ(warning_of({0.6, 0.06, 0.6}, false), "") << "it may stand on something else";
  // Depths up to 5 cm cause no warning.
  EXPECT_EQ(warning_of({-0.049}), "");
  EXPECT_NE(warning_of({-0.051}), "");
}

}  // namespace
}  // namespace weft::environment
