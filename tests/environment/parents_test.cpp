// Obstacles that follow the motion of other obstacles and of characters.
#include "film/environment/parents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "film/environment/environment.hpp"
#include "motion/rotation.hpp"
#include "support/scene_runs.hpp"

namespace weft::environment {
namespace {

constexpr double kPlaceRounding = 1e-13;  // tolerance [m]: a few rounding errors of some metres

/// An arm rises and rotates about z by a quarter turn in a second. A hand slides along the arm, and holds a ring.
const char* const kRobot = R"(
[[obstacle]]
name = "ring"
shape = "torus"
position = [3, 0, 1]
follow = "hand"

[[obstacle]]
name = "arm"
shape = "box"
interpolation = "linear"
keys = [{ time = 0, position = [1, 0, 0] }, { time = 1, position = [1, 0, 2], rotation = [0, 0, 90] }]

[[obstacle]]
name = "hand"
shape = "sphere"
follow = "arm"
interpolation = "linear"
keys = [{ time = 0, position = [2, 0, 0] }, { time = 1, position = [2.5, 0, 0], rotation = [90, 0, 0] }]
)";

TEST(Parent, LeavesWhatFollowsWhereItsOwnPoseSaysUntilItMoves) {
  const Environment environment(support::scene_of_text(kRobot));
  const motion::PoseSample ring = environment.model.pose(0, 0), hand = environment.model.pose(2, 0);
  EXPECT_LT((ring.position - Vec3(3, 0, 1)).norm(), kPlaceRounding);
  EXPECT_LT((hand.position - Vec3(2, 0, 0)).norm(), kPlaceRounding);
  EXPECT_LT(ring.rotation.angularDistance(Quat::Identity()), kPlaceRounding);
  for (const model::Body& body : environment.model.bodies) EXPECT_TRUE(body.may_move) << body.name;
}

TEST(Parent, CarriesTheOwnMotionOfWhatFollowsThroughAChain) {
  const Environment environment(support::scene_of_text(kRobot));
  // The hand has slid 1.5 m along the arm, which now points to +y, and has rotated about the arm.
  const motion::PoseSample hand = environment.model.pose(2, 1);
  EXPECT_LT((hand.position - Vec3(1, 1.5, 2)).norm(), kPlaceRounding);
  EXPECT_LT(
      hand.rotation.angularDistance(motion::about({0, 0, 1}, 90 * kDegree) * motion::about({1, 0, 0}, 90 * kDegree)),
      1e-7);
  // At t = 0 the ring is at the hand + (1, 0, 1). At t = 1 the rotation of the hand maps +x to +y and +z to +x.
  const motion::PoseSample ring = environment.model.pose(0, 1);
  EXPECT_LT((hand.rotation * Vec3(0, 0, 1) - Vec3(1, 0, 0)).norm(), 1e-7);
  EXPECT_LT((ring.position - Vec3(2, 2.5, 2)).norm(), 1e-7);
  std::vector<Vec3> placed(environment.model.bodies[0].mesh.positions.size());
  environment.model.place(0, 1, placed);
  for (std::size_t i = 0; i < placed.size(); ++i)
    EXPECT_LT((placed[i] - (ring.position + ring.rotation * environment.model.bodies[0].mesh.positions[i])).norm(),
              kPlaceRounding);
}

TEST(Parent, GivesExactDerivatives) {
  const Environment environment(support::scene_of_text(kRobot));
  const double h = 1e-4;
  const Vec3 arm(0.3, -0.2, 0.5);
  const auto place = [&](double t) -> Vec3 {
    const motion::PoseSample pose = environment.model.pose(0, t);
    return pose.position + pose.rotation * arm;
  };
  for (const double t : {0.25, 0.8}) {
    const motion::PoseSample pose = environment.model.pose(0, t);
    const Vec3 before = place(t - h), now = place(t), after = place(t + h), lever = now - pose.position;
    // Tolerances as in Obstacle.InMotionHasTheVelocityAndAccelerationOfEachVertex.
    EXPECT_LT((pose.velocity_at(lever) - (after - before) / (2 * h)).norm(), 1e-6);
    EXPECT_LT((pose.acceleration_at(lever) - (after - 2 * now + before) / (h * h)).norm(), 1e-6);
  }
}

TEST(Parent, ThatAnotherProgramMovesTakesWhatFollowsAlong) {
  Environment environment(support::scene_of_text(kRobot));
  const Quat half = motion::about({0, 0, 1}, 180 * kDegree);
  environment.model.set_motion(1, {scene::Interpolation::linear, {{0, {{1, 0, 0}}}, {1, {{0, 0, 0}, half}}}});
  // The hand is 1.5 m from the middle of the arm, which now points to -x.
  EXPECT_LT((environment.model.pose(2, 1).position - Vec3(-1.5, 0, 0)).norm(), kPlaceRounding);
  environment.model.set_motion(2, {scene::Interpolation::linear, {{0, {{2, 0, 0}}}, {1, {{7, 0, 0}}}}});
  EXPECT_LT((environment.model.pose(2, 1).position - Vec3(7, 0, 0)).norm(), kPlaceRounding)
      << "it follows nothing any more";
}

TEST(Parent, StartsWithThePreroll) {
  scene::Scene scene = support::scene_of_text(kRobot);
  scene.time.preroll = 1;
  for (scene::PoseKey& key : scene.obstacles[1].motion.keys) key.time -= 1;
  const Environment environment(scene);
  EXPECT_LT((environment.model.pose(2, -1).position - Vec3(2, 0, 0)).norm(), kPlaceRounding);
  EXPECT_LT((environment.model.pose(2, 0).position - Vec3(1, 1, 2)).norm(), kPlaceRounding);
}

TEST(Parent, ThatIsAPartOfACharacterCarriesAsAPinOnItIs) {
  const Environment environment(support::scene_of_text(R"(
[time]
duration = 2

[[character]]
name = "man"
source = "mannequin"
edge_length = 0.05
walk = 2

[[obstacle]]
name = "hat"
shape = "cylinder"
radius = 0.1
height = 0.2
position = [0, 0, 1.85]
follow = "man.head"
)"));
  ASSERT_TRUE(environment.model.bodies[0].may_move);
  EXPECT_LT((environment.model.pose(0, 0).position - Vec3(0, 0, 1.85)).norm(), 1e-9);
  const auto& parts = environment.bodies[1].parts;
  ASSERT_EQ(std::ranges::count(parts, "head", &Part::name), 1);
  // The highest vertex of the head is its top.
  const std::vector<Vec3>& skin = environment.model.bodies[1].mesh.positions;
  const auto top =
      static_cast<std::size_t>(std::ranges::max_element(skin, {}, [](const Vec3& x) { return x.z(); }) - skin.begin());
  const auto seen_from_hat = [&](double t) -> Vec3 {
    const motion::PoseSample hat = environment.model.pose(0, t);
    return hat.rotation.conjugate() * (environment.model.vertex(1, top, t).position - hat.position);
  };
  const Vec3 start = seen_from_hat(0);
  double max_change = 0, max_displacement = 0;
  for (int k = 0; k <= 100; ++k) {
    max_change = std::max(max_change, (seen_from_hat(0.02 * k) - start).norm());
    max_displacement =
        std::max(max_displacement,
                 (environment.model.pose(0, 0.02 * k).position - environment.model.pose(0, 0).position).norm());
  }
  EXPECT_GT(max_displacement, 0.5);
  EXPECT_LT(max_change, 1e-3);
}

// The bag follows the left hand, which thus becomes a part of its own. The hand must keep the setting of `hands`.
TEST(Parent, ThatIsAPartOfACharacterStaysOutOfContact) {
  const std::string man = R"(
[[character]]
name = "man"
source = "mannequin"
edge_length = 0.05
part = [{ name = "hands", collide = false }]
)";
  const std::string bag = R"(
[[obstacle]]
name = "bag"
shape = "sphere"
radius = 0.1
position = [0.6, 0, 0.7]
follow = "man.left_hand"
)";
  const Environment alone(support::scene_of_text(man)), with_bag(support::scene_of_text(man + bag));
  ASSERT_FALSE(alone.bodies[0].passed_through.empty());
  EXPECT_EQ(with_bag.bodies[1].passed_through, alone.bodies[0].passed_through);
}

}  // namespace
}  // namespace weft::environment
