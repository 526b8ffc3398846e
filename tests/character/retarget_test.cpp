#include "film/character/retarget.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "film/character/joints.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/pose.hpp"

namespace weft::character {
namespace {

// Tolerance: rounding errors of about ten conversions between rotations and quaternions.
constexpr double kRoundingOfTurns = 1e-12;

Quat about(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * kDegree, axis));
}

/// A body of sticks, z up, facing -y, so that its left is +x. At rest, the axes of each node are rotated by `frame`
/// relative to the world.
struct Builder {
  Character body;
  Quat frame;
  std::vector<Vec3> places;  // in the world

  Index add(const std::string& name, Index parent, const Vec3& place) {
    Affine global = Affine::Identity(), parent_global = Affine::Identity();
    global.linear() = frame.toRotationMatrix();
    global.translation() = place;
    if (parent >= 0) {
      parent_global.linear() = frame.toRotationMatrix();
      parent_global.translation() = places[parent];
    }
    body.nodes.push_back({name, parent, parent_global.inverse() * global});
    places.push_back(place);
    return static_cast<Index>(places.size() - 1);
  }
};

/// `size`: factor of lengths; `arm`: left arm below the horizontal, `facing`: rotation about z (angles in degrees).
Character sticks(double size, double arm, double facing, const Quat& frame, bool biped = false) {
  Builder b{{}, frame, {}};
  const Quat turn = about(Vec3::UnitZ(), facing);
  const auto at = [&](double x, double y, double z) -> Vec3 { return size * (turn * Vec3(x, y, z)); };
  const auto name = [&](const char* plain, const char* other) { return std::string(biped ? other : plain); };
  const Vec3 along = Vec3(std::cos(arm * kDegree), 0, -std::sin(arm * kDegree));
  const Vec3 shoulder(0.2, 0, 1.4), elbow = shoulder + 0.3 * along, hand = elbow + 0.3 * along;
  const Index hips = b.add(name("Hips", "Bip01 Pelvis"), -1, at(0, 0, 1));
  const Index spine = b.add(name("Spine", "Bip01 Spine"), hips, at(0, 0, 1.2));
  const Index upper =
      b.add(name("LeftUpperArm", "Bip01 L UpperArm"), spine, at(shoulder.x(), shoulder.y(), shoulder.z()));
  const Index lower = b.add(name("LeftLowerArm", "Bip01 L Forearm"), upper, at(elbow.x(), elbow.y(), elbow.z()));
  const Index palm = b.add(name("LeftHand", "Bip01 L Hand"), lower, at(hand.x(), hand.y(), hand.z()));
  const Vec3 finger = hand + 0.1 * along;
  b.add("finger", palm, at(finger.x(), finger.y(), finger.z()));
  for (const auto& [side, letter, x] : {std::tuple{"Left", "L", 0.1}, std::tuple{"Right", "R", -0.1}}) {
    const std::string plain = side, other = std::string("Bip01 ") + letter;
    const Index thigh = b.add(name((plain + "UpperLeg").c_str(), (other + " Thigh").c_str()), hips, at(x, 0, 0.95));
    const Index calf = b.add(name((plain + "LowerLeg").c_str(), (other + " Calf").c_str()), thigh, at(x, 0, 0.5));
    b.add(name((plain + "Foot").c_str(), (other + " Foot").c_str()), calf, at(x, 0, 0.1));
  }
  return b.body;
}

/// The elbow bends by 90° upward, and the hips move by `way`; directions are those of a body that faces -y.
Clip waving(const Character& body, const Vec3& way) {
  const auto joints = find_joints(body);
  const auto node = [&](const char* joint) { return joints[joint_number(joint)]; };
  const auto globals = global_transforms(body, rest_pose(body));
  const Index elbow = node("LeftLowerArm"), hips = node("Hips");
  const Quat frame(globals[elbow].linear());  // the same for all nodes
  Channel bend;
  bend.node = elbow;
  bend.rotation = {{0, 1}, {Quat::Identity(), frame.conjugate() * about(Vec3::UnitY(), -90) * frame}};
  Channel walk;
  walk.node = hips;
  const Vec3 from = globals[hips].translation();
  walk.position = {{0, 1}, {from, from + way}};
  Clip clip{"wave", 1, {bend, walk}, {}};
  return clip;
}

struct Result {
  const Character& body;
  Clip clip;
  Vec3 place(const std::string& joint, double t) const {
    const auto joints = find_joints(body);
    const auto globals = global_transforms(body, pose_at(body, clip, t));
    return globals[joints[joint_number(joint)]].translation();
  }
  Vec3 finger(double t) const {  // a node that is no joint
    const auto globals = global_transforms(body, pose_at(body, clip, t));
    for (std::size_t n = 0; n < body.nodes.size(); ++n)
      if (body.nodes[n].name == "finger") return globals[n].translation();
    return Vec3::Zero();
  }
  Vec3 direction(const std::string& from, const std::string& to, double t) const {
    return (place(to, t) - place(from, t)).normalized();
  }
};

Result retargeted(const Character& body, const Character& motion, const Clip& clip) {
  const auto ours = find_joints(body), theirs = find_joints(motion);
  return {body, retarget({body, ours}, {motion, theirs}, clip, Vec3::UnitZ()).clip};
}

/// Finds the joints of a body by their names alone: bone lengths carry no information.
std::vector<Index> find_prefixed(Character body) {
  double length = 0.1;
  for (Node& node : body.nodes)
    if (node.parent >= 0) node.local.translation() *= length += 0.37;
  return find_joints(body);
}

const Quat kOwnFrame = about(Vec3(1, 2, -1).normalized(), 77);

TEST(Retarget, OntoTheSameSkeletonIsTheSameMotion) {
  const Character body = sticks(1, 0, 0, kOwnFrame);
  const Clip clip = waving(body, {0.1, -0.7, 0});
  const Result result = retargeted(body, body, clip);
  for (const double t : {0.0, 0.3, 1.0})
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      const auto expected = global_transforms(body, pose_at(body, clip, t));
      const auto got = global_transforms(body, pose_at(body, result.clip, t));
      EXPECT_LT((got[n].matrix() - expected[n].matrix()).norm(), kRoundingOfTurns) << body.nodes[n].name << t;
    }
}

TEST(Retarget, LaysAnArmInAPoseAlongTheMotionInTPose) {
  const Character motion = sticks(1, 0, 0, Quat::Identity());
  const Character body = sticks(1, 50, 0, kOwnFrame, true);
  const Result result = retargeted(body, motion, waving(motion, Vec3::Zero()));
  EXPECT_LT((result.direction("LeftUpperArm", "LeftLowerArm", 0) - Vec3::UnitX()).norm(), kRoundingOfTurns);
  EXPECT_LT((result.direction("LeftLowerArm", "LeftHand", 0) - Vec3::UnitX()).norm(), kRoundingOfTurns);
  EXPECT_LT((result.direction("LeftUpperArm", "LeftLowerArm", 1) - Vec3::UnitX()).norm(), kRoundingOfTurns);
  EXPECT_LT(((result.finger(0) - result.place("LeftHand", 0)).normalized() - Vec3::UnitX()).norm(), kRoundingOfTurns)
      << "hands go with their arms";
  EXPECT_LT((result.direction("LeftLowerArm", "LeftHand", 1) - Vec3::UnitZ()).norm(), kRoundingOfTurns);
}

TEST(Retarget, ScalesTheWayByTheLegsAndTurnsItToWhereTheBodyFaces) {
  const Character motion = sticks(17, 0, 0, Quat::Identity());  // in another unit of length
  const Character body = sticks(1.1, 20, 90, kOwnFrame, true);  // faces +x
  const Result result = retargeted(body, motion, waving(motion, {0, -17, 0}));
  EXPECT_LT((result.place("Hips", 0) - Vec3(0, 0, 1.1)).norm(), kRoundingOfTurns) << "starts where the body stands";
  EXPECT_LT((result.place("Hips", 1) - Vec3(1.1, 0, 1.1)).norm(), kRoundingOfTurns);
  EXPECT_LT((result.direction("LeftLowerArm", "LeftHand", 1) - Vec3::UnitZ()).norm(), kRoundingOfTurns);
  EXPECT_LT((result.direction("LeftUpperArm", "LeftLowerArm", 1) - Vec3::UnitY()).norm(), kRoundingOfTurns);
}

TEST(Retarget, PutsTheLowestFootOfTheClipWhereTheFeetStandAtRest) {
  // The ground of the motion is 3 m below its origin.
  Character motion = sticks(1, 0, 0, Quat::Identity());
  Clip clip = waving(motion, {0, 0, 0.25});
  for (Vec3& x : clip.channels[1].position.values) x.z() -= 3;
  const Character body = sticks(2, 0, 0, Quat::Identity());
  const Result result = retargeted(body, motion, clip);
  EXPECT_NEAR(result.place("LeftFoot", 0).z(), 0.2, kRoundingOfTurns);
  EXPECT_NEAR(result.place("LeftFoot", 1).z(), 0.2 + 0.5, kRoundingOfTurns);
}

TEST(Joints, OfTheUsualRigsAreFoundByName) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> rigs = {
      {"plain",
       {"Hips", "Spine", "Chest", "Neck", "Head", "LeftShoulder", "LeftUpperArm", "LeftLowerArm", "LeftHand",
        "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToes", "RightUpperArm"}},
      {"Mixamo",
       {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine2", "mixamorig:Neck", "mixamorig:Head",
        "mixamorig:LeftShoulder", "mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand",
        "mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot", "mixamorig:LeftToeBase",
        "mixamorig:RightArm"}},
      {"Biped",
       {"Bip01 Pelvis", "Bip01 Spine", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head", "Bip01 L Clavicle",
        "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand", "Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot",
        "Bip01 L Toe0", "Bip01 R UpperArm"}},
      {"Poser",
       {"hip", "abdomen", "chest", "neck", "head", "lCollar", "lShldr", "lForeArm", "lHand", "lThigh", "lShin", "lFoot",
        "lToe", "rShldr"}},
      {"Blender; its legs through FBX",
       {"hips", "spine", "chest", "neck", "head", "shoulder.L", "upper_arm.L", "forearm.L", "hand.L", "thighFBXASC046L",
        "shinFBXASC046L", "footFBXASC046L", "toeFBXASC046L", "upper_arm.R"}},
      {"Unreal",
       {"pelvis", "spine_01", "spine_03", "neck_01", "head", "clavicle_l", "upperarm_l", "lowerarm_l", "hand_l",
        "thigh_l", "calf_l", "foot_l", "ball_l", "upperarm_r"}},
      {"by joints",
       {"Hips", "Ab", "Chest", "Neck", "Head", "LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftHip",
        "LeftKnee", "LeftAnkle", "LeftToe", "RightShoulder"}},
      {"Character Creator",
       {"CC_Base_Pelvis", "CC_Base_Waist", "CC_Base_Spine02", "CC_Base_NeckTwist01", "CC_Base_Head",
        "CC_Base_L_Clavicle", "CC_Base_L_Upperarm", "CC_Base_L_Forearm", "CC_Base_L_Hand", "CC_Base_L_Thigh",
        "CC_Base_L_Calf", "CC_Base_L_Foot", "CC_Base_L_ToeBase", "CC_Base_R_Upperarm"}},
      {"VRM",
       {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_UpperChest", "J_Bip_C_Neck", "J_Bip_C_Head", "J_Bip_L_Shoulder",
        "J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand", "J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot",
        "J_Bip_L_ToeBase", "J_Bip_R_UpperArm"}},
      {"Meebits, as VRM",
       {"HipsBone", "SpineBone", "ChestBone", "NeckBone", "HeadBone", "LeftShoulderBone", "LeftUpperArmBone",
        "LeftLowerArmBone", "LeftHandBone", "LeftUpperLegBone", "LeftLowerLegBone", "LeftFootBone", "LeftToesBone",
        "RightUpperArmBone"}},
      {"Cats of Blender, as VRM",
       {"Hips", "Spine", "Chest", "Neck", "Head", "Left shoulder", "Left arm", "Left elbow", "Left wrist", "Left leg",
        "Left knee", "Left ankle", "Left toe", "Right arm"}},
      {"SMPL",
       {"Pelvis", "Spine1", "Spine3", "Neck", "Head", "L_Collar", "L_Shoulder", "L_Elbow", "L_Wrist", "L_Hip", "L_Knee",
        "L_Ankle", "L_Foot", "R_Shoulder"}},
      {"Bandai",
       {"Hips", "Spine", "Chest", "Neck", "Head", "Shoulder_L", "UpperArm_L", "LowerArm_L", "Hand_L", "UpperLeg_L",
        "LowerLeg_L", "Foot_L", "Toes_L", "UpperArm_R"}},
      {"Acclaim",
       {"hips", "lowerback", "thorax", "lowerneck", "head", "lclavicle", "lhumerus", "lradius", "lwrist", "lfemur",
        "ltibia", "lfoot", "ltoes", "rhumerus"}},
      {"Quaternius",
       {"Hips", "Abdomen", "Chest", "Neck", "Head", "Shoulder.L", "UpperArm.L", "LowerArm.L", "Palm.L", "UpperLeg.L",
        "LowerLeg.L", "Foot.L", "Toes.L", "UpperArm.R"}},
      {"Truebones",
       {"BN_Bip01_Pelvis", "BN_Bip01_Spine", "BN_Bip01_Spine1", "BN_Bip01_Neck", "BN_Bip01_Head", "BN_Bip01_L_Clavicle",
        "BN_Bip01_L_UpperArm", "BN_Bip01_L_Forearm", "BN_Bip01_L_Hand", "BN_Bip01_L_Thigh", "BN_Bip01_L_Calf",
        "BN_Bip01_L_Foot", "BN_Bip01_L_Toe0", "BN_Bip01_R_UpperArm"}},
  };
  const std::vector<std::string>& joints = rigs[0].second;
  for (const auto& [rig, names] : rigs) {
    std::vector<Node> nodes{{"Armature", -1, Affine::Identity()}, {"LHipJoint", 0, Affine::Identity()}};
    for (const std::string& name : names) nodes.push_back({name, 0, Affine::Identity()});
    const auto found = find_named_joints(nodes);
    for (std::size_t k = 0; k < joints.size(); ++k)
      EXPECT_EQ(found[joint_number(joints[k])], static_cast<Index>(k + 2)) << rig << " " << joints[k];
    EXPECT_EQ(found[joint_number("RightFoot")], -1) << rig;
    EXPECT_EQ(found[joint_number("RightShoulder")], -1) << rig;
  }
}

TEST(Joints, AreNoMeshesOfTheSameName) {
  const std::vector<Node> nodes{{"Head", -1, Affine::Identity()}, {"mixamorig:Head", -1, Affine::Identity()}};
  EXPECT_EQ(find_named_joints(nodes)[joint_index(Joint::head)], 0);
  EXPECT_EQ(find_named_joints(nodes, {false, true})[joint_index(Joint::head)], 1);
}

TEST(Joints, OfTheTrunkAreWhereLimbsPart) {
  // A skeleton as in 100STYLE: four chests and no spine.
  std::vector<Node> nodes;
  const auto add = [&](const std::string& name, Index parent) {
    nodes.push_back({name, parent, Affine(Eigen::Translation3d(0, 0, 0.1))});
    return static_cast<Index>(nodes.size() - 1);
  };
  Index last = add("Hips", -1);
  for (const char* name : {"Chest", "Chest2", "Chest3", "Chest4"}) last = add(name, last);
  add("LeftShoulder", add("LeftCollar", last));
  add("RightShoulder", add("RightCollar", last));
  for (const char* leg : {"LeftHip", "RightHip"}) add(leg, 0);
  auto found = find_named_joints(nodes);
  EXPECT_EQ(found[joint_index(Joint::hips)], 0);
  EXPECT_EQ(found[joint_index(Joint::spine)], 2);
  EXPECT_EQ(found[joint_index(Joint::chest)], 4);
  // Rigs of Character Creator and Rigify: the legs are children of a pelvis beside the spine; no node is called hips.
  nodes.clear();
  const Index hip = add("CC_Base_Hip", add("root", -1)), pelvis = add("CC_Base_Pelvis", hip);
  last = add("CC_Base_Spine01", add("CC_Base_Waist", hip));
  for (const char* leg : {"CC_Base_L_Thigh", "CC_Base_R_Thigh"}) add(leg, pelvis);
  for (const char* arm : {"CC_Base_L_Upperarm", "CC_Base_R_Upperarm"}) add(arm, last);
  found = find_named_joints(nodes);
  EXPECT_EQ(found[joint_index(Joint::hips)], hip);
  ASSERT_GE(found[joint_index(Joint::spine)], 0);
  EXPECT_EQ(nodes[found[joint_index(Joint::spine)]].name, "CC_Base_Waist");
  EXPECT_EQ(found[joint_index(Joint::chest)], last);
}

TEST(Joints, OfRigifyAndBipedAreFoundInTheirTrees) {
  std::vector<Node> nodes;
  const auto add = [&](const std::string& name, Index parent) {
    nodes.push_back({name, parent, Affine(Eigen::Translation3d(0, 0, 1))});
    return static_cast<Index>(nodes.size() - 1);
  };
  // Each limb consists of two nodes, one for each half.
  Index last = add("DEF-spine", add("root", -1));
  for (const char* leg : {"DEF-thigh.L", "DEF-thigh.R"}) add(leg, last);
  for (const char* name : {"DEF-spine.001", "DEF-spine.002", "DEF-spine.003"}) last = add(name, last);
  for (const char* side : {".L", ".R"})
    add(std::string("DEF-forearm") + side,
        add(std::string("DEF-upper_arm") + side + ".001",
            add(std::string("DEF-upper_arm") + side, add(std::string("DEF-shoulder") + side, last))));
  add("DEF-spine.006", add("DEF-spine.005", add("DEF-spine.004", last)));
  auto found = find_named_joints(nodes);
  const auto name_of = [&](Joint joint) {
    return found[joint_index(joint)] < 0 ? "" : nodes[found[joint_index(joint)]].name;
  };
  EXPECT_EQ(name_of(Joint::hips), "DEF-spine");
  EXPECT_EQ(name_of(Joint::spine), "DEF-spine.001");
  EXPECT_EQ(name_of(Joint::chest), "DEF-spine.003");
  EXPECT_EQ(name_of(Joint::neck), "DEF-spine.004");
  EXPECT_EQ(name_of(Joint::head), "DEF-spine.006");
  EXPECT_EQ(name_of(Joint::left_upper_arm), "DEF-upper_arm.L");
  EXPECT_EQ(name_of(Joint::right_lower_arm), "DEF-forearm.R");
  // In this rig, the arms are children of the neck.
  nodes.clear();
  const Index pelvis = add("Bip01 Pelvis", add("Bip01", -1));
  last = add("Bip01 Spine", pelvis);
  for (const char* leg : {"Bip01 L Thigh", "Bip01 R Thigh"}) add(leg, last);
  last = add("Bip01 Neck", add("Bip01 Spine1", last));
  add("Bip01 Head", last);
  for (const char* side : {"L", "R"})
    add(fmt::format("Bip01 {} UpperArm", side), add(fmt::format("Bip01 {} Clavicle", side), last));
  found = find_named_joints(nodes);
  EXPECT_EQ(name_of(Joint::hips), "Bip01 Pelvis");
  EXPECT_EQ(name_of(Joint::chest), "Bip01 Spine1");
  EXPECT_EQ(name_of(Joint::neck), "Bip01 Neck");
}

TEST(Joints, OfRigsWhoseNameStandsBeforeAllNodesAreFound) {
  const Character plain = make_mannequin({.edge_length = 0.1});
  const std::vector<Index> expected = find_joints(plain);
  for (const std::string rig : {"UnityChan_", "rig_DEF-"}) {
    Character body = plain;
    for (Node& node : body.nodes) node.name = rig + node.name;
    EXPECT_EQ(find_joints(body), expected) << rig;
    // A rig without skin comes first in the list of nodes.
    const auto shift = static_cast<Index>(plain.nodes.size());
    for (Node& node : body.nodes) node.parent += node.parent < 0 ? 0 : shift;
    for (Bone& bone : body.bones) bone.node += shift;
    std::vector<Node> two = plain.nodes;
    for (Node& node : two) node.name = "metarig_" + node.name;
    two.insert(two.end(), body.nodes.begin(), body.nodes.end());
    body.nodes = two;
    const std::vector<Index> found = find_joints(body);
    for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_EQ(found[j], expected[j] + shift) << rig << joint_names()[j];
  }
}

// All node names begin with the name of the rig, as in "EthanLeftArm", or end with a suffix that a program adds.
TEST(Joints, OfRigsWhoseNameIsPartOfAllNamesAreFound) {
  const Character plain = make_mannequin({.edge_length = 0.1});
  const std::vector<Index> expected = find_joints(plain);
  for (const auto& [beginning, end] :
       {std::pair{"Ethan", ""}, {"soldier", ""}, {"", "_jnt"}, {"", "Bind"}, {"Ethan", "_jnt"}, {"Hero_", "_end"}}) {
    Character body = plain;
    for (Node& node : body.nodes) node.name = beginning + node.name + end;
    // Nodes outside the skeleton have unrelated names.
    body.nodes.push_back({"Camera", -1, Affine::Identity()});
    EXPECT_EQ(find_prefixed(body), expected) << beginning << "..." << end;
  }
}

TEST(Joints, AreFoundWithTheNumbersThatSketchfabPutsBehindNamesAndWithoutColons) {
  // Names of bones of published characters. Only names are given, no hierarchy.
  const std::vector<std::vector<std::string>> rigs = {
      {"CC_Base_Hip_02", "CC_Base_L_Upperarm_050", "CC_Base_L_Forearm_051", "CC_Base_R_Upperarm_078",
       "CC_Base_R_Forearm_079", "CC_Base_L_Thigh_04", "CC_Base_L_Calf_05", "CC_Base_R_Thigh_019", "CC_Base_R_Calf_020",
       "CC_Base_L_Foot_06", "CC_Base_L_ToeBase_08", "CC_Base_R_Foot_022", "CC_Base_R_ToeBase_023", "CC_Base_L_Hand_055",
       "CC_Base_L_Index1_065", "CC_Base_L_Index2_066", "CC_Base_L_Index3_067"},
      {"hips_00", "l arm_028", "l forearm_029", "r arm_09", "r forearm_010", "l leg_047", "l knee_048", "r leg_051",
       "r knee_052", "l foot_049", "l toes_050", "r foot_053", "r toes_054", "l hand_030", "l index1_043",
       "l index2_044", "l index3_045"},
      {"mixamorigHips", "mixamorigLeftArm", "mixamorigLeftForeArm", "mixamorigRightArm", "mixamorigRightForeArm",
       "mixamorigLeftUpLeg", "mixamorigLeftLeg", "mixamorigRightUpLeg", "mixamorigRightLeg", "mixamorigLeftFoot",
       "mixamorigLeftToeBase", "mixamorigRightFoot", "mixamorigRightToeBase", "mixamorigLeftHand"}};
  const std::vector<Joint> joints = {Joint::hips,
                                     Joint::left_upper_arm,
                                     Joint::left_lower_arm,
                                     Joint::right_upper_arm,
                                     Joint::right_lower_arm,
                                     Joint::left_upper_leg,
                                     Joint::left_lower_leg,
                                     Joint::right_upper_leg,
                                     Joint::right_lower_leg,
                                     Joint::left_foot,
                                     Joint::left_toes,
                                     Joint::right_foot,
                                     Joint::right_toes,
                                     Joint::left_hand};
  for (const auto& names : rigs) {
    Character body;
    body.nodes.push_back({"Armature", -1, Affine::Identity()});
    for (const std::string& name : names) body.nodes.push_back({name, 0, Affine::Identity()});
    const std::vector<Index> found = find_joints(body);
    for (std::size_t k = 1; k < joints.size(); ++k)
      EXPECT_EQ(found[joint_index(joints[k])], static_cast<Index>(k + 1)) << names[k];
  }
}

/// A clip of local rotations with which upper and lower arms of a mannequin point in the given directions.
Clip arms_along(const Character& body, const std::array<std::array<Vec3, 2>, 2>& directions) {
  Clip clip{"arms", 1, {}, {}};
  const auto joints = find_joints(body);
  const auto at = global_transforms(body, rest_pose(body));
  for (const bool right : {false, true}) {
    Quat above =
        to_placement(at[body.nodes[joints[joint_index(on_side(Joint::left_upper_arm, right))]].parent]).rotation;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t joint = joint_index(on_side(Joint::left_upper_arm, right)) + k;
      const Vec3 bone = at[joints[joint + 1]].translation() - at[joints[joint]].translation();
      const Quat turned = Quat::FromTwoVectors(bone, directions[right][k]) * to_placement(at[joints[joint]]).rotation;
      Channel channel;
      channel.node = joints[joint];
      const Quat local = above.conjugate() * turned;
      channel.rotation = {{0, 1}, {local, local}};
      clip.channels.push_back(channel);
      above = turned;
    }
  }
  return clip;
}

// The forearms of the motion are longer. If each arm were retargeted alone, the hands would be 10 cm farther apart.
TEST(Retarget, KeepsHandsTogetherThatAreTogetherInTheMotion) {
  const Character body = make_mannequin({.edge_length = 0.1});
  Character motion = body;
  const auto joints = find_joints(body);
  for (const bool right : {false, true})
    motion.nodes[joints[joint_index(on_side(Joint::left_hand, right))]].local.translation() *= 1.4;
  const auto way = [](double x, double y, double z) { return Vec3(x, y, z).normalized(); };
  const Clip clip =
      arms_along(motion, {{{way(0.1, -0.6, -0.8), way(-0.42, -0.9, 0)}, {way(-0.1, -0.6, -0.8), way(0.42, -0.9, 0)}}});
  const auto hand_difference = [&](const Character& of, const Clip& by) {
    const auto at = global_transforms(of, pose_at(of, by, 0.5));
    const auto hand = [&](Joint joint) -> Vec3 { return at[joints[joint_index(joint)]].translation(); };
    return Vec3(hand(Joint::left_hand) - hand(Joint::right_hand));
  };
  const auto arm = [&](const Character& of) {
    const auto length = [&](Joint joint) { return of.nodes[joints[joint_index(joint)]].local.translation().norm(); };
    return length(Joint::left_lower_arm) + length(Joint::left_hand);
  };
  ASSERT_LT(hand_difference(motion, clip).norm(), 0.24 * arm(motion)) << "they are together";
  const Retargeted result = retarget({body, joints}, {motion, joints}, clip, Vec3::UnitZ());
  EXPECT_LT((hand_difference(body, result.clip) - arm(body) / arm(motion) * hand_difference(motion, clip)).norm(),
            1e-3);
}

TEST(Retarget, WarnsOfJointAnglesBeyondHumanReach) {
  const Character motion = sticks(1, 0, 0, Quat::Identity());
  Clip clip = waving(motion, Vec3::Zero());
  clip.channels[0].rotation.values[1] = about(Vec3::UnitY(), -175);
  const Character body = sticks(1, 30, 0, kOwnFrame);
  const auto ours = find_joints(body), theirs = find_joints(motion);
  const Retargeted result = retarget({body, ours}, {motion, theirs}, clip, Vec3::UnitZ());
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0], "LeftLowerArm bends by 175° at 1 s of the motion; people reach 165°");
}

// The animal has a horizontal trunk along -y and four legs of 0.5 m.
TEST(Retarget, NamesTheMotionOfAnAnimalWithFourLegs) {
  Builder b{{}, Quat::Identity(), {}};
  const Index hips = b.add("Hips", -1, {0, 0, 0.5});
  const Index chest = b.add("Chest", b.add("Spine", hips, {0, -0.4, 0.52}), {0, -0.7, 0.5});
  b.add("Head", b.add("Neck", chest, {0, -0.8, 0.6}), {0, -0.9, 0.7});
  for (const auto& [side, x] : {std::pair{"Left", 0.1}, {"Right", -0.1}}) {
    const std::string which = side;
    const Index elbow = b.add(which + "LowerArm", b.add(which + "UpperArm", chest, {x, -0.7, 0.45}), {x, -0.68, 0.25});
    b.add(which + "Hand", elbow, {x, -0.7, 0.03});
    const Index knee = b.add(which + "LowerLeg", b.add(which + "UpperLeg", hips, {x, 0, 0.5}), {x, -0.02, 0.25});
    b.add(which + "Foot", knee, {x, 0, 0.03});
  }
  const Character motion = b.body;
  const Character body = sticks(1, 30, 0, kOwnFrame);
  const auto ours = find_joints(body), theirs = find_joints(motion);
  const auto warnings = retarget({body, ours}, {motion, theirs}, waving(motion, {0, -1, 0}), Vec3::UnitZ()).warnings;
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& text) {
    return text.find("on all fours in 100 % of its time, as animals with four legs do") != std::string::npos;
  })) << fmt::format("{}", fmt::join(warnings, "; "));
}

TEST(Retarget, WarnsOfABodyThatDoesNotStandInItsFile) {
  const Character motion = sticks(1, 0, 0, Quat::Identity());
  Character body = sticks(1, 30, 0, kOwnFrame);
  const auto ours = find_joints(body), theirs = find_joints(motion);
  const auto warnings = [&] {
    return retarget({body, ours}, {motion, theirs}, waving(motion, Vec3::Zero()), Vec3::UnitZ()).warnings;
  };
  EXPECT_TRUE(warnings().empty());
  Node& shin = body.nodes[ours[joint_index(Joint::left_lower_leg)]];
  shin.local.rotate(kOwnFrame.conjugate() * about(Vec3::UnitX(), 60) * kOwnFrame);
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_NE(warnings()[0].find("a knee bent by 60°"), std::string::npos) << warnings()[0];
}

// In the motion, the node of the hips is a control, 0.4 m above the start of the spine.
TEST(Retarget, OfHipsAboveTheSpineIsUpright) {
  Character motion = make_mannequin({.edge_length = 0.1});
  const auto joints = find_joints(motion);
  const Character body = motion;
  motion.nodes[joints[0]].local.pretranslate(Vec3(0, 0, 0.4));
  for (const Joint joint : {Joint::spine, Joint::left_upper_leg, Joint::right_upper_leg})
    motion.nodes[joints[joint_index(joint)]].local.pretranslate(Vec3(0, 0, -0.4));
  Clip clip{"lean", 1, {}, {}};  // leans farther than a standing body can
  Channel lean;
  lean.node = joints[0];
  lean.rotation = {{0, 1}, {about(Vec3::UnitX(), 30), about(Vec3::UnitX(), 30)}};
  clip.channels.push_back(lean);
  const Retargeted result = retarget({body, joints}, {motion, joints}, clip, Vec3::UnitZ());
  const auto at = global_transforms(body, pose_at(body, result.clip, 0.5));
  const auto place = [&](Joint joint) -> Vec3 { return at[joints[joint_index(joint)]].translation(); };
  EXPECT_GT(to_placement(at[joints[0]]).rotation.toRotationMatrix()(2, 2), 0.7) << "hips";
  EXPECT_GT(place(Joint::head).z() - place(Joint::hips).z(), 0.4);
}

}  // namespace
}  // namespace weft::character
