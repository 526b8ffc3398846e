// Parts of bodies: the skin of the mannequin is compared with the nearest bone; other tests use small skeletons.
#include "film/character/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <span>

#include "film/character/joints.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {
namespace {

std::vector<std::string> names_of(const std::string& part) {
  std::vector<std::string> names;
  for (const Index joint : joints_of_part(part)) names.push_back(joint_names()[joint]);
  return names;
}

TEST(Parts, AreGroupsOrJointsInAnyCase) {
  EXPECT_EQ(names_of("hands"), (std::vector<std::string>{"LeftHand", "RightHand"}));
  EXPECT_EQ(names_of("Feet"), (std::vector<std::string>{"LeftFoot", "LeftToes", "RightFoot", "RightToes"}));
  EXPECT_EQ(names_of("head"), (std::vector<std::string>{"Neck", "Head"})) << "the group comes before the joint";
  EXPECT_EQ(names_of("left_upper_arm"), std::vector<std::string>{"LeftUpperArm"});
  EXPECT_TRUE(names_of("tail").empty());
  for (const std::string& name : part_names()) EXPECT_FALSE(joints_of_part(name).empty()) << name;
}

TEST(Parts, OfTheMannequinLieWhereTheyBelong) {
  const MannequinBuild build{.edge_length = 0.03};
  const Character body = make_mannequin(build);
  const auto joints = mannequin_joints(build);
  const std::vector<Index> nodes = find_joints(body);
  const VertexMask hands = vertices_of(body, nodes, joints_of_part("hands"));
  const VertexMask torso = vertices_of(body, nodes, joints_of_part("torso"));
  const auto joint = [&](Joint j) { return joints[static_cast<std::size_t>(j)]; };
  int in_hands = 0;
  for (std::size_t v = 0; v < hands.size(); ++v) {
    Vec3 x = body.mesh.positions[v];
    x.x() = std::abs(x.x());
    in_hands += hands[v];
    // Within 4 cm of a joint, skin may belong to either of the two bones.
    const Vec3 arm = joint(Joint::left_hand) - joint(Joint::left_lower_arm);
    const double beyond = (x - joint(Joint::left_hand)).dot(arm.normalized());
    EXPECT_TRUE(!hands[v] || beyond > -0.04) << x.transpose();
    EXPECT_FALSE(hands[v] && torso[v]);
    EXPECT_TRUE(!torso[v] || x.z() > joint(Joint::left_upper_leg).z() - 0.2) << x.transpose();
  }
  EXPECT_GT(in_hands, 100);
  EXPECT_FALSE(has_fingers(body, nodes)) << "they are one with the palm";
}

/// A hand of `fingers` bones below an arm. Each bone has one vertex, except the bone "ring".
Character hand_with(int fingers) {
  Character body;
  body.nodes = {{"Hips", -1, {}}, {"LeftLowerArm", 0, {}}, {"LeftHand", 1, {}}, {"ring", 2, {}}};
  for (int f = 0; f < fingers; ++f) body.nodes.push_back({"finger" + std::to_string(f), 2, {}});
  for (Index n = 0; n < static_cast<Index>(body.nodes.size()); ++n) {
    if (n == 3) continue;  // this bone has no skin
    const auto bone = static_cast<Index>(body.bones.size());
    body.bones.push_back({n, Affine::Identity()});
    body.first_influence.push_back(static_cast<Index>(body.influences.size()));
    body.influences.push_back({bone, 1});
    body.mesh.positions.push_back(Vec3::Zero());
    body.material_of_vertex.push_back(n % 2);
  }
  body.first_influence.push_back(static_cast<Index>(body.influences.size()));
  return body;
}

TEST(Parts, HoldWhatIsBelowTheirJointsAndNodes) {
  const Character body = hand_with(3);
  const std::vector<Index> nodes = find_joints(body);
  EXPECT_EQ(vertices_of(body, nodes, joints_of_part("LeftHand")), (VertexMask{0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(vertices_of(body, nodes, joints_of_part("LeftLowerArm")), (VertexMask{0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(vertices_below(body, 1), (VertexMask{0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(vertices_of_material(body, 1), (VertexMask{0, 1, 0, 0, 1, 0}));
}

TEST(Parts, FingersAreThreeChainsThatHoldSkin) {
  for (const int fingers : {0, 1, 2, 3, 5}) {
    const Character body = hand_with(fingers);
    EXPECT_EQ(has_fingers(body, find_joints(body)), fingers >= 3) << fingers;
  }
}

TEST(Parts, BelongToWhateverHoldsHalf) {
  Character body = hand_with(0);
  body.influences = {{0, 1}, {1, 0.5}, {2, 0.5}, {2, 0.4}, {1, 0.6}};
  body.first_influence = {0, 1, 3, 5};
  const std::vector<Index> nodes = find_joints(body);
  EXPECT_EQ(vertices_of(body, nodes, joints_of_part("LeftHand")), (VertexMask{0, 1, 0}));
}

// One follower must not change the skin that another one follows, even if it is far from the body, such as a balloon.
TEST(Parts, FollowersFollowTheSameSkinWhateverElseFollows) {
  const Character body = make_mannequin({.edge_length = 0.05});
  const Pose rest = rest_pose(body);
  const VertexMask all(body.mesh.positions.size(), 1);
  const Vec3 cape(0.15, 0.1, 1.4), balloon(0, 0, 30);
  Character alone = body, beside = body;
  add_followers(alone, rest, all, std::span(&cape, 1));
  add_followers(beside, rest, all, std::span(&balloon, 1));
  add_followers(beside, rest, all, std::span(&cape, 1));
  const auto weights_of_last = [](const Character& followed) {
    std::map<Index, double> weights;
    const std::size_t last = followed.mesh.positions.size() - 1;
    for (Index i = followed.first_influence[last]; i < followed.first_influence[last + 1]; ++i)
      weights[followed.influences[i].bone] = followed.influences[i].weight;
    return weights;
  };
  EXPECT_EQ(weights_of_last(beside), weights_of_last(alone));
}

TEST(Parts, LimbsAreArmsAndLegsAndTheRestIsTrunk) {
  const Character body = make_mannequin({.edge_length = 0.03});
  const std::vector<Index> nodes = find_joints(body);
  const std::vector<Limb> limbs = limbs_of(body, nodes);
  const VertexMask arms = vertices_of(body, nodes, joints_of_part("arms")),
                   legs = vertices_of(body, nodes, joints_of_part("legs"));
  for (std::size_t v = 0; v < limbs.size(); ++v) {
    const bool left = body.mesh.positions[v].x() > 0;
    const Limb expected = arms[v] != 0   ? left ? Limb::left_arm : Limb::right_arm
                          : legs[v] != 0 ? left ? Limb::left_leg : Limb::right_leg
                                         : Limb::trunk;
    // In the crotch, both legs have the same weight, so either result is right.
    const bool between = limbs[v] == Limb::trunk && legs[v] != 0 && std::abs(body.mesh.positions[v].x()) < 0.02;
    if (!between) {
      EXPECT_EQ(limbs[v], expected) << v << " at " << body.mesh.positions[v].transpose();
    }
  }
}

}  // namespace
}  // namespace weft::character
