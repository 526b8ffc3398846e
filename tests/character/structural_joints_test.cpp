#include "film/character/structural_joints.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "film/character/joints.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {
namespace {

/// A body of sticks, z up, facing -y (left at +x), with arms stretched out. Its nodes are named j0, j1, ...; `parts`
/// lists which joint each node is.
struct Sticks {
  Character body;
  std::vector<std::string> parts;

  Index add(const std::string& part, Index parent, const Vec3& offset) {
    Affine local = Affine::Identity();
    local.translation() = offset;
    body.nodes.push_back({fmt::format("j{}", body.nodes.size()), parent, local});
    parts.push_back(part);
    return static_cast<Index>(parts.size() - 1);
  }

  void limbs(Index hips, Index chest, double side, double collar, double hand) {
    const std::string which = side > 0 ? "Left" : "Right";
    const Index thigh = add(which + "UpperLeg", hips, {0.1 * side, 0, -0.05});
    const Index shin = add(which + "LowerLeg", thigh, {0, -0.01, -0.4});
    const Index foot = add(which + "Foot", shin, {0, 0.01, -0.4});
    add("", add(which + "Toes", foot, {0, -0.15, -0.05}), {0, -0.05, 0});
    const Index shoulder = add(which + "Shoulder", chest, {0.03 * side, 0, 0.1});
    const Index arm = add(which + "UpperArm", shoulder, {collar * side, 0, 0});
    const Index fore = add(which + "LowerArm", arm, {0.28 * side, 0, 0});
    const Index palm = add(which + "Hand", fore, {0.2 * side, 0, 0});
    for (const double finger : {-0.06, -0.03, -0.01, 0.01, 0.03}) {
      const double along = finger < -0.05 ? 0.03 : hand;
      add("", add("", palm, {along * side, finger, 0}), {0.08 * side, 0, 0});
    }
  }

  Index of(const std::string& part) const {
    const auto found = std::find(parts.begin(), parts.end(), part);
    return found == parts.end() ? -1 : static_cast<Index>(found - parts.begin());
  }
};

/// `right_first`: limbs of the right side come first; `pelvis`: the legs are children of a node beside the spine.
Sticks make_sticks(bool right_first, bool pelvis, double collar = 0.15, double hand = 0.09) {
  Sticks s;
  const Index hips = s.add("Hips", s.add("", -1, {0, 0, 0}), {0, 0, 1});
  const Index legs = pelvis ? s.add("", hips, {0, 0, -0.02}) : hips;
  const Index spine = s.add("Spine", hips, {0, 0, 0.1}), chest = s.add("Chest", spine, {0, 0, 0.15});
  for (const double side : {right_first ? -1.0 : 1.0, right_first ? 1.0 : -1.0})
    s.limbs(legs, chest, side, collar, hand);
  const Index head = s.add("Head", s.add("Neck", chest, {0, 0, 0.2}), {0, -0.02, 0.1});
  s.add("", head, {0.03, -0.08, 0.08});  // an eye
  s.add("", head, {-0.03, -0.08, 0.08});
  return s;
}

void expect_all_found(const Sticks& s) {
  const std::vector<Index> joints = find_joints(s.body);
  for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_EQ(joints[j], s.of(joint_names()[j])) << joint_names()[j];
}

TEST(NamelessJoints, AreFoundByTreeAndLengths) {
  for (const bool right_first : {false, true})
    for (const bool pelvis : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", right_first, pelvis));
      expect_all_found(make_sticks(right_first, pelvis));
    }
}

TEST(NamelessJoints, OfLongCollarbonesAndLargeHandsAreFound) {
  expect_all_found(make_sticks(false, false, 0.25));
  expect_all_found(make_sticks(false, false, 0.15, 0.3));
}

// Rigs with twist bones have a node in the middle of upper arms, lower arms, thighs and shins.
TEST(NamelessJoints, OfBonesInTwoHalvesAreTheirEnds) {
  const Sticks whole = make_sticks(false, true);
  Sticks s;
  std::vector<Index> now;
  for (std::size_t n = 0; n < whole.parts.size(); ++n) {
    const Node& node = whole.body.nodes[n];
    const std::string& part = whole.parts[n];
    Index parent = node.parent < 0 ? -1 : now[static_cast<std::size_t>(node.parent)];
    Vec3 offset = node.local.translation();
    if (part.ends_with("LowerLeg") || part.ends_with("Foot") || part.ends_with("LowerArm") || part.ends_with("Hand")) {
      offset /= 2;
      parent = s.add("", parent, offset);
    }
    now.push_back(s.add(part, parent, offset));
  }
  expect_all_found(s);
}

TEST(NamelessJoints, OfTheMannequinAreThoseThatItsNamesSay) {
  Character body = make_mannequin({.edge_length = 0.1});
  const std::vector<Index> named = find_joints(body);
  for (std::size_t n = 0; n < body.nodes.size(); ++n) body.nodes[n].name = fmt::format("j{}", n);
  EXPECT_EQ(find_joints(body), named);
}

TEST(NamelessJoints, AreNotGuessedWhereNothingTellsTheLeft) {
  Sticks s = make_sticks(false, false);
  for (const char* side : {"Left", "Right"}) {  // straight legs without feet
    s.body.nodes[s.of(std::string(side) + "LowerLeg")].local.translation().y() = 0;
    s.body.nodes[s.of(std::string(side) + "Foot")].local.translation().y() = 0;
    s.body.nodes[s.of(std::string(side) + "Toes")].local.translation().y() = 0;
    s.body.nodes[s.of(std::string(side) + "Toes") + 1].local.translation().y() = 0;
  }
  for (const Index joint : find_joints(s.body)) EXPECT_EQ(joint, -1);
}

TEST(NamelessJoints, OfABodyWithoutArmsAreNotGuessed) {
  Sticks s = make_sticks(false, false);
  s.body.nodes.resize(static_cast<std::size_t>(s.of("RightUpperLeg")));
  for (const Index joint : find_joints(s.body)) EXPECT_EQ(joint, -1);
}

TEST(NamelessJoints, StandInWhereNamesAreMissing) {
  Sticks s = make_sticks(true, false);
  s.body.nodes[s.of("Hips")].name = "pelvis";
  s.body.nodes[s.of("Head")].name = "head";
  s.body.nodes[s.of("LeftFoot")].name = "foot_l";
  expect_all_found(s);
}

TEST(Knuckles, AreThoseOfIndexAndLittleFinger) {
  for (const bool right_first : {false, true}) {
    const Sticks s = make_sticks(right_first, false);
    for (const char* hand : {"LeftHand", "RightHand"}) {
      const Index palm = s.of(hand);
      const std::array<Index, 2> knuckles = find_knuckles(s.body, palm);
      EXPECT_EQ(knuckles[0], palm + 3);
      EXPECT_EQ(knuckles[1], palm + 9);
    }
    EXPECT_EQ(find_knuckles(s.body, s.of("Head"))[0], -1);
  }
}

// A thumb on the wrong side would turn the palm by 180 degrees.
TEST(Knuckles, AreUnknownIfTheThumbIsAsLongAsAFinger) {
  for (const double rounding : {-1e-7, 1e-7}) {
    Sticks s = make_sticks(false, false);
    const Index palm = s.of("LeftHand"), thumb = palm + 1, middle = palm + 5;
    const auto root = [&](Index finger) { return s.body.nodes[at(finger)].local.translation().norm(); };
    s.body.nodes[at(thumb + 1)].local.translation().x() = root(middle) + 0.08 - root(thumb) + rounding;
    EXPECT_EQ(find_knuckles(s.body, palm)[0], -1) << rounding;
  }
}

}  // namespace
}  // namespace weft::character
