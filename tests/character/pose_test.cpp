#include "film/character/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/parallel.hpp"

namespace weft::character {
namespace {

// Tolerance: a few rounding errors of numbers of size 1.
constexpr double kRounding = 1e-14;

Affine shift(double x, double y, double z) {
  Affine map = Affine::Identity();
  map.translation() = Vec3(x, y, z);
  return map;
}

/// An arm along x: shoulder at 0, elbow at 1, vertices at 0.5, 1 and 2. The middle vertex has equal weights of both
/// bones.
Character arm() {
  Character arm;
  arm.nodes = {{"shoulder", -1, Affine::Identity()}, {"elbow", 0, shift(1, 0, 0)}};
  arm.bones = {{0, Affine::Identity()}, {1, shift(-1, 0, 0)}};
  arm.mesh.positions = {{0.5, 0, 0}, {1, 0.1, 0}, {2, 0, 0}};
  arm.first_influence = {0, 1, 3, 4};
  arm.influences = {{0, 1}, {0, 0.5}, {1, 0.5}, {1, 1}};
  return arm;
}

std::vector<Vec3> vertices(const Character& character, const Pose& pose) {
  std::vector<Vec3> x(character.mesh.positions.size());
  skin(character, pose, x);
  return x;
}

TEST(Skin, AtRestIsTheMeshAsBound) {
  const Character body = arm();
  const auto x = vertices(body, rest_pose(body));
  for (std::size_t v = 0; v < x.size(); ++v) EXPECT_LT((x[v] - body.mesh.positions[v]).norm(), kRounding);
}

TEST(Skin, FollowsItsBonesAndBlendsThem) {
  const Character body = arm();
  Pose pose = rest_pose(body);
  pose.nodes[1].rotation = Eigen::AngleAxisd(90 * kDegree, Vec3::UnitZ());  // the forearm points along y
  const auto x = vertices(body, pose);
  EXPECT_LT((x[0] - Vec3(0.5, 0, 0)).norm(), kRounding);
  EXPECT_LT((x[2] - Vec3(1, 1, 0)).norm(), kRounding);
  // Expected: the middle between (1, 0.1) and (0.9, 0), to which the forearm moves it.
  EXPECT_LT((x[1] - Vec3(0.95, 0.05, 0)).norm(), kRounding);
}

TEST(Skin, AddsMorphTargetsByTheirWeightBeforeTheBones) {
  Character body = arm();
  body.morphs.push_back({"thick", {Vec3(0, 0.2, 0), Vec3::Zero(), Vec3(0, 0.4, 0)}, 0.5});
  Pose pose = rest_pose(body);
  EXPECT_EQ(pose.morphs, std::vector<double>{0.5});
  pose.nodes[1].rotation = Eigen::AngleAxisd(90 * kDegree, Vec3::UnitZ());
  const auto x = vertices(body, pose);
  EXPECT_LT((x[0] - Vec3(0.5, 0.1, 0)).norm(), kRounding);
  EXPECT_LT((x[2] - Vec3(0.8, 1, 0)).norm(), kRounding);
}

TEST(Skin, HasTheSameBitsForAnyNumberOfThreads) {
  Character body = arm();
  std::mt19937 random(3);
  for (int v = 3; v < 9000; ++v) {
    body.mesh.positions.emplace_back(random() % 1000 / 700.0, random() % 1000 / 900.0, 0.3);
    body.influences.push_back({0, 0.3});
    body.influences.push_back({1, 0.7});
    body.first_influence.push_back(static_cast<Index>(body.influences.size()));
  }
  Pose pose = rest_pose(body);
  pose.nodes[1].rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized());
  set_thread_count(1);
  const auto one = vertices(body, pose);
  set_thread_count(0);
  EXPECT_EQ(vertices(body, pose), one);
}

TEST(Placement, PutTogetherIsTheMapItCameFrom) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-2, 2);
  for (int trial = 0; trial < 100; ++trial) {
    Affine map = Affine::Identity();
    for (int i = 0; i < 12; ++i)
      map.matrix()(i % 3, i / 3) = number(random);  // any affine map, with shear, mirrored or not
    const Placement placement = to_placement(map);
    EXPECT_LT((placement.to_affine().matrix() - map.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(placement.rotation.norm(), 1, kRounding);
  }
  Affine flat = Affine::Identity();
  flat.linear() = Vec3(1, 0, 1).asDiagonal();
  EXPECT_LT((to_placement(flat).to_affine().matrix() - flat.matrix()).norm(), kRounding);
}

TEST(Placement, OfAScaledRotationHasTheScaleInItsStretch) {
  Affine map = Affine::Identity();
  map.linear() = Eigen::AngleAxisd(1, Vec3(1, 1, 0).normalized()).toRotationMatrix() * Vec3(2, 3, 4).asDiagonal();
  EXPECT_LT((to_placement(map).stretch - Mat3(Vec3(2, 3, 4).asDiagonal())).norm(), kRounding);
}

/// The elbow turns from 0 to 170° between 1 s and 3 s and grows to twice its size.
Clip bending() {
  Clip clip{"bend", 4, {}, {}};
  Channel elbow;
  elbow.node = 1;
  elbow.rotation = {{1, 3}, {Quat::Identity(), Quat(Eigen::AngleAxisd(170 * kDegree, Vec3::UnitZ()))}};
  elbow.scale = {{0, 4}, {Vec3::Ones(), 2 * Vec3::Ones()}};
  clip.channels.push_back(elbow);
  return clip;
}

TEST(PoseAt, TurnsEvenlyBetweenKeysAndStandsOutside) {
  const Character body = arm();
  const Clip clip = bending();
  for (const auto& [t, degrees] :
       {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.5, 42.5}, {2.0, 85.0}, {3.0, 170.0}, {9.0, 170.0}}) {
    const Pose pose = pose_at(body, clip, t);
    EXPECT_LT(pose.nodes[1].rotation.angularDistance(Quat(Eigen::AngleAxisd(degrees * kDegree, Vec3::UnitZ()))), 1e-7)
        << t;
    EXPECT_EQ(pose.nodes[1].position, Vec3(1, 0, 0)) << "no key: as at rest";
  }
  EXPECT_LT((pose_at(body, clip, 1).nodes[1].stretch - 1.25 * Mat3::Identity()).norm(), kRounding);
}

TEST(PoseAt, TurnsTheShortestWayWhateverTheSignOfTheKeys) {
  const Character body = arm();
  Clip clip = bending();
  clip.channels[0].rotation.values[1].coeffs() *= -1;
  EXPECT_LT(
      pose_at(body, clip, 2).nodes[1].rotation.angularDistance(Quat(Eigen::AngleAxisd(85 * kDegree, Vec3::UnitZ()))),
      1e-7);
}

// If a clip of a glTF file lacks the translation, rotation or scale of a node, assimp adds a key with the value of the
// node. In this test, it is a negative scale, which must not mirror the node twice.
TEST(PoseAt, MirrorsANodeOnceIfAClipHasItsNegativeScale) {
  Character body = arm();
  const Mat3 turned = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Mat3& rotation : {Mat3(Mat3::Identity()), turned})
    for (const Vec3& scale : {Vec3(-1, 1, 1), Vec3(1, -2, 1), Vec3(-1, -1, 1), Vec3(-1, -1, -3)}) {
      body.nodes[1].local.linear() = rotation * scale.asDiagonal();
      Clip clip{"shift", 1, {}, {}};
      Channel elbow;
      elbow.node = 1;
      elbow.position = {{0, 1}, {Vec3(1, 0, 0), Vec3(2, 0, 0)}};
      elbow.scale = {{0}, {scale}};
      clip.channels.push_back(elbow);
      const Pose pose = pose_at(body, clip, 1), rest = rest_pose(body);
      EXPECT_LT((pose.nodes[1].to_affine().linear() - body.nodes[1].local.linear()).norm(), 10 * kRounding)
          << scale.transpose();
      EXPECT_EQ(pose.nodes[1].position, Vec3(2, 0, 0));
      const Placement between = blend(rest, pose, 0.5).nodes[1];
      EXPECT_LT((between.to_affine().linear() - body.nodes[1].local.linear()).norm(), 10 * kRounding)
          << scale.transpose();
    }
}

TEST(Blend, GoesFromOnePoseToTheOther) {
  const Character body = arm();
  const Pose rest = rest_pose(body), bent = pose_at(body, bending(), 3);
  EXPECT_LT(blend(rest, bent, 0).nodes[1].rotation.angularDistance(rest.nodes[1].rotation), 1e-7);
  EXPECT_LT(blend(rest, bent, 1).nodes[1].rotation.angularDistance(bent.nodes[1].rotation), 1e-7);
  EXPECT_NEAR(blend(rest, bent, 0.25).nodes[1].rotation.angularDistance(rest.nodes[1].rotation), 42.5 * kDegree, 1e-7);
}

TEST(ShortestRotation, IsThatOfEigenToTheLastBit) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 1000; ++round) {
    const Vec3 from(normal(random), normal(random), normal(random));
    Vec3 to(normal(random), normal(random), normal(random));
    if (round % 2 == 1) to = -from + 1e-3 * to;  // nearly opposite to `from`
    EXPECT_EQ(shortest_rotation(from, to).coeffs(), Quat::FromTwoVectors(from, to).coeffs());
  }
}

TEST(ShortestRotation, TurnsToTheOppositeDirection) {
  for (const Vec3& from : {Vec3(0, 0, 2), Vec3(-3, 0, 0), Vec3(1, 2, 3)}) {
    const Quat rotation = shortest_rotation(from, -2 * from);
    EXPECT_NEAR(rotation.norm(), 1, kRounding);
    EXPECT_LT((rotation * from + from).norm(), kRounding * from.norm());
  }
}

}  // namespace
}  // namespace weft::character
