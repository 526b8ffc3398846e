#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "film/assets/character_file.hpp"
#include "film/character/anatomy.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/pose.hpp"
#include "film/character/retarget.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

using character::Joint;

constexpr int kKeys = 13;
constexpr double kKeyTime = 0.1;  // [s]

struct Bone {
  std::string name;
  int parent = -1;
  Vec3 offset;      // from the parent in the pose with arms stretched out, y up, body facing z [cm]
  Vec3 axis;        // of its rotation
  double from = 0;  // range of the angle [degrees]
  double to = 0;
};

/// A body with long shins and short arms that swings its arms and legs, turns and nods. Joints have the names of the
/// CMU recordings.
std::vector<Bone> make_bones() {
  std::vector<Bone> bones = {{"Hips", -1, {0, 95, 0}, {0, 1, 0}, -20, 20},
                             {"LowerBack", 0, {0, 8, -1}, {1, 0, 0}, 5, -3},
                             {"Spine1", 1, {0, 30, -2}, {0, 1, 0}, 15, -15},
                             {"Neck", 2, {0, 16, 1}, {1, 0, 0}, 0, 12},
                             {"Head", 3, {0, 9, 2}, {0, 1, 0}, -30, 30}};
  for (const double side : {1.0, -1.0}) {
    const std::string which = side > 0 ? "Left" : "Right";
    const auto first = static_cast<int>(bones.size());
    bones.push_back({which + "Shoulder", 2, {3 * side, 12, 0}, {0, 0, 1}, 0, 6});
    bones.push_back({which + "Arm", first, {14 * side, 0, 0}, {0, side, -side}, 80, 30});
    bones.push_back({which + "ForeArm", first + 1, {24 * side, 0, 0}, {0, -side, 0}, 10, 70});
    bones.push_back({which + "Hand", first + 2, {22 * side, 0, 0}, {side, 0, 0}, 0, 40});
    bones.push_back({which + "UpLeg", 0, {9 * side, -4, 0}, {1, 0, 0}, -25 * side, 25 * side});
    bones.push_back({which + "Leg", first + 4, {0, -40, 0}, {1, 0, 0}, 10, 50});
    bones.push_back({which + "Foot", first + 5, {0, -44, 0}, {1, 0, 0}, -10, 15});
    bones.push_back({which + "ToeBase", first + 6, {2 * side, -6, 14}, {1, 0, 0}, 0, -20});
  }
  return bones;
}

/// Rotation of a bone relative to its parent at a key.
Quat turn_of(const Bone& bone, int key) {
  const double fraction = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * key / kKeys);
  const double degrees = bone.from + (bone.to - bone.from) * fraction;
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, bone.axis.normalized()));
}

/// Translation channels of the joints below the root: none; three zeros; or three that repeat the offset of the joint.
enum class Translations { none, of_zero, of_offsets };

/// Writes BVH text. With all angles at zero, joint j is rotated by zero[j] in the world; children are sorted by
/// `order`.
std::string write_bvh(const std::vector<Bone>& bones, const std::vector<Quat>& zero, const std::vector<double>& order,
                      Translations translations) {
  std::string text = "HIERARCHY\n", channels;
  std::vector<std::size_t> written;
  const auto children = [&](int parent) {
    std::vector<std::size_t> list;
    for (std::size_t b = 0; b < bones.size(); ++b)
      if (bones[b].parent == parent) list.push_back(b);
    std::sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) { return order[a] < order[b]; });
    return list;
  };
  const auto write = [&](const auto& self, std::size_t b) -> void {
    const int parent = bones[b].parent;
    const Vec3 offset = parent < 0 ? Vec3(Vec3::Zero()) : Vec3(zero[parent].conjugate() * bones[b].offset);
    text += fmt::format("{} {}\n{{\nOFFSET {:.9f} {:.9f} {:.9f}\nCHANNELS {}Zrotation Yrotation Xrotation\n",
                        parent < 0 ? "ROOT" : "JOINT", bones[b].name, offset.x(), offset.y(), offset.z(),
                        parent < 0 || translations != Translations::none ? "6 Xposition Yposition Zposition " : "3 ");
    written.push_back(b);
    const auto below = children(static_cast<int>(b));
    for (const std::size_t child : below) self(self, child);
    if (below.empty()) text += "End Site\n{\nOFFSET 0 0 0\n}\n";
    text += "}\n";
  };
  write(write, 0);
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: {}\n", kKeys, kKeyTime);
  for (int key = 0; key < kKeys; ++key) {
    for (const std::size_t b : written) {
      const int parent = bones[b].parent;
      if (parent < 0) text += fmt::format("{} {} {} ", 3 * key, 95 + key % 2, 10 * key);
      if (parent >= 0 && translations != Translations::none) {
        const Vec3 offset = zero[parent].conjugate() * bones[b].offset;
        const Vec3 x = translations == Translations::of_zero ? Vec3(Vec3::Zero()) : offset;
        text += fmt::format("{:.9f} {:.9f} {:.9f} ", x.x(), x.y(), x.z());
      }
      const Quat before = parent < 0 ? Quat::Identity() : zero[parent].conjugate();
      const Vec3 zyx = (before * turn_of(bones[b], key) * zero[b]).toRotationMatrix().eulerAngles(2, 1, 0);
      for (const double angle : zyx) text += fmt::format("{:.9f} ", angle * 180 / std::numbers::pi);
    }
    text += "\n";
  }
  return text;
}

/// The same with all joints unrotated, and children in the order of `bones`.
std::string write_bvh(const std::vector<Bone>& bones, Translations translations = Translations::none) {
  return write_bvh(bones, std::vector<Quat>(bones.size(), Quat::Identity()), std::vector<double>(bones.size(), 0),
                   translations);
}

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double max = 0;
  for (std::size_t v = 0; v < a.size(); ++v) max = std::max(max, (a[v] - b[v]).norm());
  return max;
}

class RetargetedBvh : public support::TestFolder {
 protected:
  /// Positions of the vertices of the body at some keys.
  std::vector<Vec3> vertices(const std::string& bvh) {
    const std::filesystem::path file = folder_ / "motion.bvh";
    support::write_bytes(file, bvh);
    const LoadedCharacter motion = load_motion(file, {}, "test");
    const auto ours = character::find_joints(body_), theirs = character::find_joints(motion.character);
    result_ =
        character::retarget({body_, ours}, {motion.character, theirs}, motion.character.clips.front(), Vec3::UnitZ());
    std::vector<Vec3> all, at(body_.mesh.positions.size());
    for (const int key : {0, 5, 9}) {
      character::skin(body_, character::pose_at(body_, result_.clip, key * kKeyTime), at);
      all.insert(all.end(), at.begin(), at.end());
    }
    return all;
  }

  const character::Character body_ = character::make_mannequin({.edge_length = 0.06});
  character::Retargeted result_;
};

TEST_F(RetargetedBvh, DoesNotDependOnZeroPosesOrTheOrderOfJoints) {
  const std::vector<Bone> bones = make_bones();
  std::vector<double> order(bones.size(), 0);
  const std::vector<Vec3> expected = vertices(write_bvh(bones));
  std::mt19937 random(18);
  const auto number = [&] { return random() / double(std::mt19937::max()) * 2 - 1; };
  for (int seed = 0; seed < 20; ++seed) {
    std::vector<Quat> zero;
    for (std::size_t b = 0; b < bones.size(); ++b) {
      zero.push_back(Quat(number(), number(), number(), number()).normalized());
      order[b] = number();
    }
    const std::vector<Vec3> got = vertices(write_bvh(bones, zero, order, Translations::none));
    // Tolerance: assimp stores offsets and rotations in single precision; measured: 2e-6 m.
    EXPECT_LT(max_distance(got, expected), 1e-4) << seed;
  }
}

// MakeHuman writes translations that are added to the offsets of joints; recordings write translations that replace the
// offsets.
TEST_F(RetargetedBvh, WithSixChannelsOnEveryJointKeepsItsBones) {
  const std::vector<Bone> bones = make_bones();
  const std::vector<Vec3> expected = vertices(write_bvh(bones));
  for (const Translations translations : {Translations::of_zero, Translations::of_offsets}) {
    const std::vector<Vec3> got = vertices(write_bvh(bones, translations));
    EXPECT_LT(max_distance(got, expected), 1e-4)
        << (translations == Translations::of_zero ? "of zero" : "of the offsets");
  }
}

TEST_F(RetargetedBvh, MayHaveKeywordsInAnySpellingAndSpacesInNames) {
  std::vector<Bone> bones = make_bones();
  const std::vector<Vec3> expected = vertices(write_bvh(bones));
  for (Bone& bone : bones) bone.name = "My " + bone.name;
  std::string text = write_bvh(bones);
  const std::size_t frames = text.find("Frames:");
  for (std::size_t i = 0; i < frames; ++i)
    if (text.compare(i, 3, "My ") != 0) text[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
  text.replace(frames, 7, "frames :");
  const std::size_t time = text.find("Frame Time:");
  text.replace(time, 11, "FrameTime:");
  EXPECT_EQ(vertices(text), expected);
}

TEST_F(RetargetedBvh, NeedsNoNames) {
  std::vector<Bone> bones = make_bones();
  const std::vector<double> order(bones.size(), 0);
  const std::vector<Vec3> expected = vertices(write_bvh(bones));
  std::vector<Quat> zero;
  for (std::size_t b = 0; b < bones.size(); ++b) {
    bones[b].name = fmt::format("j{}", b);
    zero.push_back(Quat(1 + static_cast<double>(b % 3), static_cast<double>(b % 5), 2, -1).normalized());
  }
  const std::vector<Vec3> got = vertices(write_bvh(bones, zero, order, Translations::none));
  EXPECT_LT(max_distance(got, expected), 1e-4);  // tolerance: single precision, as in the first test
}

TEST_F(RetargetedBvh, PointsLimbsWhereThoseOfTheMotionPointAndBendsThemForward) {
  const std::vector<Bone> bones = make_bones();
  vertices(write_bvh(bones));
  const auto joints = character::find_joints(body_);
  const character::Skeleton skeleton({body_, joints});
  EXPECT_TRUE(result_.warnings.empty()) << result_.warnings.front();
  for (int key = 0; key < kKeys; ++key) {
    std::vector<Quat> turned;
    for (const Bone& bone : bones)
      turned.push_back(bone.parent < 0 ? turn_of(bone, key) : turned[bone.parent] * turn_of(bone, key));
    const auto posture = skeleton.at(character::pose_at(body_, result_.clip, key * kKeyTime));
    // Rotates the motion so that up is z instead of y, and its left is that of the body, +x. The left of the motion is
    // the mean direction across hips and shoulders at the start.
    const Quat up(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
    const Quat hips = turn_of(bones[0], 0), chest = hips * turn_of(bones[1], 0) * turn_of(bones[2], 0);
    const Vec3 left_first = up * Vec3(hips * Vec3::UnitX() + chest * Vec3::UnitX());
    const Quat face(Eigen::AngleAxisd(-std::atan2(left_first.y(), left_first.x()), Vec3::UnitZ()));
    for (const auto& [joint, bone] : {std::pair{Joint::left_upper_arm, 6},
                                      {Joint::left_lower_arm, 7},
                                      {Joint::right_upper_arm, 14},
                                      {Joint::right_lower_arm, 15}}) {
      const Vec3 theirs = face * (up * (turned[bone] * bones[bone + 1].offset));
      EXPECT_LT((skeleton.bone(posture, joint).normalized() - theirs.normalized()).norm(), 1e-2) << key << name(joint);
    }
    for (const bool right : {false, true}) {
      const Vec3 thigh = skeleton.bone(posture, on_side(Joint::left_upper_leg, right));
      const Vec3 shin = skeleton.bone(posture, on_side(Joint::left_lower_leg, right));
      const Vec3 left =
          posture.places[joint_index(Joint::left_upper_leg)] - posture.places[joint_index(Joint::right_upper_leg)];
      EXPECT_GT(thigh.cross(shin).dot(left), 0) << key;
    }
  }
}

}  // namespace
}  // namespace weft::assets
