// Positions of joints in BVH files with any number of channels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "support/small_character.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

class BvhChannels : public support::TestFolder {
 protected:
  /// The channel of a joint of a motion. `channels`: of the hips and of the spine; `frames`: their values at two times.
  character::Channel channel(const std::string& joint, const std::vector<std::string>& channels,
                             const std::vector<std::string>& frames) {
    std::string text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS " + channels[0] + "\nJOINT " + child_ +
                       "\n{\nOFFSET 0 5 1\nCHANNELS " + channels[1] +
                       "\nEnd Site\n{\nOFFSET 0 5 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 1\n" + frames[0] + "\n" +
                       frames[1] + "\n";
    if (hierarchy_on_one_line_)
      std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("\nMOTION")), '\n', ' ');
    support::write_bytes(folder_ / "motion.bvh", text);
    const LoadedCharacter motion =
        load_motion(folder_ / "motion.bvh", {{}, scene::FileUp::as_file, scene::UpAxis::y}, "here");
    const auto& nodes = motion.character.nodes;
    const auto node = std::ranges::find(nodes, joint, &character::Node::name) - nodes.begin();
    for (const character::Channel& each : motion.character.clips.at(0).channels)
      if (each.node == node) return each;
    ADD_FAILURE() << "no channel of " << joint;
    return {};
  }

  bool hierarchy_on_one_line_ = false;
  std::string child_ = "Spine";  // name of the second joint
};

TEST_F(BvhChannels, OfPositionsAloneMoveTheRoot) {
  const std::vector<std::string> channels{"3 Xposition Yposition Zposition", "3 Zrotation Yrotation Xrotation"},
      frames{"1 2 3 0 0 0", "4 5 6 0 0 90"};
  EXPECT_EQ(channel("Hips", channels, frames).position.values, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  const Quat turned = channel("Spine", channels, frames).rotation.values.at(1);
  EXPECT_LT(turned.angularDistance(Quat(Eigen::AngleAxisd(90 * kDegree, Vec3::UnitX()))), 1e-6);
}

// Coordinates without a channel stay those of the offset, and values that follow stay those of their channels.
TEST_F(BvhChannels, OfOneCoordinateMoveAJointAlongIt) {
  const std::vector<std::string> channels{"4 Xposition Zposition Yrotation Xrotation", "2 Yposition Xrotation"},
      frames{"1 3 0 0 6 0", "4 6 0 90\n7 90"};
  EXPECT_EQ(channel("Hips", channels, frames).position.values, (std::vector<Vec3>{{1, 0, 3}, {4, 0, 6}}));
  EXPECT_EQ(channel("Spine", channels, frames).position.values, (std::vector<Vec3>{{0, 6, 1}, {0, 7, 1}}));
  for (const char* joint : {"Hips", "Spine"}) {
    const Quat turned = channel(joint, channels, frames).rotation.values.at(1);
    EXPECT_LT(turned.angularDistance(Quat(Eigen::AngleAxisd(90 * kDegree, Vec3::UnitX()))), 1e-6) << joint;
  }
}

TEST_F(BvhChannels, OfJointsWithEqualNamesMoveEach) {
  child_ = "Hips";
  const std::vector<std::string> channels{"3 Zrotation Yrotation Xrotation", "3 Zrotation Yrotation Xrotation"},
      frames{"0 0 0 0 0 0", "0 0 0 0 0 90"};
  const Quat turned = channel("Hips_", channels, frames).rotation.values.at(1);
  EXPECT_LT(turned.angularDistance(Quat(Eigen::AngleAxisd(90 * kDegree, Vec3::UnitX()))), 1e-6);
}

// In BVH, any white space separates words.
TEST_F(BvhChannels, MayBeInOneLineWithTheirJoints) {
  const std::vector<std::string> channels{"4 Xposition Zposition Yrotation Xrotation", "2 Yposition Xrotation"},
      frames{"1 3 0 0 6 0", "4 6 0 90 7 90"};
  hierarchy_on_one_line_ = true;
  EXPECT_EQ(channel("Hips", channels, frames).position.values, (std::vector<Vec3>{{1, 0, 3}, {4, 0, 6}}));
  EXPECT_EQ(channel("Spine", channels, frames).position.values, (std::vector<Vec3>{{0, 6, 1}, {0, 7, 1}}));
}

TEST_F(BvhChannels, OfSeveralSkeletonsOrWithoutFramesAreRefused) {
  const auto expect_refused = [&](const std::string& from, const std::string& to, const std::string& words) {
    support::write_bytes(folder_ / "motion.bvh", support::replaced(support::walk_file(), from, to));
    support::expect_error(ExitCode::asset_unreadable, words, [&] { load_motion(folder_ / "motion.bvh", {}, "here"); });
  };
  expect_refused("Frames: 2", "frames:0", "motion.bvh: expected at least one frame, got Frames: 0");
  expect_refused("MOTION", "ROOT Other {\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n}\nMOTION",
                 "motion.bvh: expected one skeleton, got 2 (ROOT); export each to a file of its own");
}

}  // namespace
}  // namespace weft::assets
