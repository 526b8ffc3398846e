// Tests of CollisionStage: positions of particles, pins and bodies at both ends of a step; velocities due to pushes.
#include "physics/simulation/collision_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/numerics.hpp"
#include "physics/simulation/step_settings.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation {
namespace {

// A sheet over a floor, and a ball that passes under it at 4 m/s. At 0.21 s the ball's x coordinates are near zero, so
// that they differ if the time is rounded in another way.
scene::Scene sheet_over_a_ball() {
  scene::Scene scene = testing::sheet_alone(0.4, 5, 1);
  scene.contact.obstacles = true;
  scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
  scene.obstacles.push_back(testing::obstacle("ball", scene::Sphere{.radius = 0.1}));
  scene.obstacles[1].segments = 8;
  scene.obstacles[1].motion.keys = {{0, {{-0.84, 0, 0.3}, Quat::Identity()}},
                                    {1, {{3.16, 0.1, 0.5}, Quat::Identity()}}};
  return scene;
}

class CollisionStages : public ::testing::Test {
 protected:
  CollisionStages() : model_(environment::Environment(sheet_over_a_ball()).model), cloth_(model_) {
    now_.x = model_.cloths[0].start;
    now_.v.assign(25, Vec3(0.1, 0.2, 0.3));
    now_.bodies_time = 0.2;
    stage_.emplace(model_, cloth_, now_);
    next_ = now_;
  }

  /// Positions of floor and ball at time t [s], in the order in which they follow the particles.
  std::vector<Vec3> bodies_at(double t) const {
    std::vector<Vec3> floor(model_.bodies[0].mesh.positions.size()), ball(model_.bodies[1].mesh.positions.size());
    model_.place(0, t, floor);
    model_.place(1, t, ball);
    floor.insert(floor.end(), ball.begin(), ball.end());
    return floor;
  }
  static std::vector<Vec3> bodies_of(const SystemState& moment) { return {moment.x.begin() + 25, moment.x.end()}; }

  model::Model model_;
  ClothSystem cloth_;
  SystemState now_, next_;
  std::optional<CollisionStage> stage_;
};

TEST_F(CollisionStages, PlaceBodiesBehindTheParticlesForBothEndsOfAStep) {
  EXPECT_EQ(bodies_of(now_), bodies_at(0.2));
  stage_->begin_step(0.2, 0.01, {}, now_, next_);
  EXPECT_EQ(bodies_of(now_), bodies_at(0.2));
  EXPECT_EQ(bodies_of(next_), bodies_at(0.2 + 0.01));
  EXPECT_NE(bodies_of(now_), bodies_of(next_));
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(now_.x[i], model_.cloths[0].start[i]);
    EXPECT_EQ(next_.x[i], now_.x[i] + 0.01 * now_.v[i]);  // predicted from the unchanged velocity
  }
}

TEST_F(CollisionStages, PlaceBodiesAgainWhereStepsMeetAtTimesThatAreRoundedOtherwise) {
  stage_->begin_step(0.2, 0.01, {}, now_, next_);
  std::swap(now_, next_);
  const double t = std::nextafter(0.2 + 0.01, 1);
  ASSERT_NE(bodies_at(t), bodies_of(now_));
  stage_->begin_step(t, 0.02, {}, now_, next_);
  EXPECT_EQ(bodies_of(now_), bodies_at(t));
  EXPECT_EQ(bodies_of(next_), bodies_at(t + 0.02));
  stage_->begin_step(t, 0.01, {}, now_, next_);  // the step was rejected and is repeated with half its length
  EXPECT_EQ(bodies_of(now_), bodies_at(t));
  EXPECT_EQ(bodies_of(next_), bodies_at(t + 0.01));
}

TEST_F(CollisionStages, ExpectHeldParticlesWhereTheyAreHeld) {
  const integrator::HeldParticle pin{{7, Mat3::Zero()}, Vec3(1, 2, 3), Vec3::Zero()};
  stage_->begin_step(0.2, 0.01, {&pin, 1}, now_, next_);
  EXPECT_EQ(next_.x[7], Vec3(1, 2, 3));
}

// The solved end of the sheet is 1 mm below the floor. The push out of the floor also changes the velocities.
TEST_F(CollisionStages, GiveParticlesTheVelocityOfTheirPush) {
  stage_->begin_step(0.2, 0.01, {}, now_, next_);
  for (std::size_t i = 0; i < 25; ++i) {
    next_.x[i] = now_.x[i] - Vec3(0, 0, 1.001);
    next_.v[i] = Vec3(0, 0, -100.1);
  }
  const SystemState solved = next_;
  ASSERT_FALSE(stage_->is_separated(now_, next_));
  ASSERT_EQ(stage_->push_apart(0.01, false, true, now_, next_), std::nullopt);
  EXPECT_TRUE(stage_->is_separated(now_, next_));
  double largest = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_LT((next_.v[i] - solved.v[i] - (next_.x[i] - solved.x[i]) / 0.01).norm(), 1e-12);
    largest = std::max(largest, (next_.x[i] - solved.x[i]).norm());
  }
  EXPECT_GT(largest, 0.001);
  EXPECT_EQ(bodies_of(next_), bodies_of(solved));
}

// A continuation whose positions differ by less than the restored gap finds the same contacts, hence the same solution.
TEST_F(CollisionStages, TellAContinuationThatLeadsBackToItsStart) {
  stage_->begin_step(0.2, 0.01, {}, now_, next_);
  EXPECT_FALSE(stage_->restarts_at(next_)) << "the solve has not continued yet";
  stage_->continue_from(next_);
  EXPECT_TRUE(stage_->restarts_at(next_));
  next_.x[3].x() += 0.9 * numerics.separation.restored_gap;
  EXPECT_TRUE(stage_->restarts_at(next_));
  next_.x[24].z() += 1.1 * numerics.separation.restored_gap;
  EXPECT_FALSE(stage_->restarts_at(next_)) << "one particle is elsewhere";
  stage_->begin_step(0.2, 0.005, {}, now_, next_);
  EXPECT_FALSE(stage_->restarts_at(next_)) << "a new attempt";
}

// In a step of 0.1 s, the blade makes half a turn, so its vertices would move straight through its middle. The block is
// within reach of the turning blade, out of its reach, or not yet released. Forces move a block in the whole step in
// which it is released.
TEST(TurningObstacle, IsSeenByBodiesThatForcesMove) {
  const auto turns_too_far = [](double y, double release) {
    scene::Scene scene;
    scene.time.step = 0.1;
    scene.obstacles.push_back(testing::obstacle("blade", scene::BoxShape{{0.3, 0.02, 0.02}}));
    scene.obstacles[0].motion.interpolation = scene::Interpolation::linear;
    const Quat half_a_turn(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ()));
    scene.obstacles[0].motion.keys = {{0, scene::Pose{}}, {0.1, {Vec3::Zero(), half_a_turn}}};
    scene.obstacles.push_back(testing::obstacle("block", scene::BoxShape{{0.02, 0.02, 0.02}}, {0, y, 0}));
    scene.obstacles[1].mass = 0.1;
    scene.obstacles[1].release = release;
    const model::Model model = environment::Environment(scene).model;
    const ClothSystem cloth(model);
    SystemState now = start_of(model, cloth, 0);
    const CollisionStage stage(model, cloth, now);
    return stage.obstacle_turns_too_far(0, 0.1, now);
  };
  EXPECT_TRUE(turns_too_far(0.1, 0));
  EXPECT_FALSE(turns_too_far(0.5, 0));
  EXPECT_FALSE(turns_too_far(0.1, 1));
  EXPECT_TRUE(turns_too_far(0.1, 0.05));
}

// The tip is 0.3 m from the hub that it follows. In a step of 0.1 s, the hub turns by 0.2 rad: the path of the tip
// deviates from its chord by 1.5 mm, of which only 0.09 mm are due to the own size of the tip. The margin is 0.19 mm.
TEST(TurningObstacle, SwingsWhatFollowsIt) {
  const auto turns_too_far = [](double y) {
    scene::Scene scene;
    scene.time.step = 0.1;
    scene.obstacles.push_back(testing::obstacle("hub", scene::BoxShape{{0.02, 0.02, 0.02}}));
    scene.obstacles[0].motion.interpolation = scene::Interpolation::linear;
    scene.obstacles[0].motion.keys = {{0, scene::Pose{}},
                                      {0.1, {Vec3::Zero(), Quat(Eigen::AngleAxisd(0.2, Vec3::UnitZ()))}}};
    scene.obstacles.push_back(testing::obstacle("tip", scene::BoxShape{{0.02, 0.02, 0.02}}, {0.3, 0, 0}));
    scene.obstacles[1].follow = "hub";
    scene.obstacles.push_back(testing::obstacle("block", scene::BoxShape{{0.02, 0.02, 0.02}}, {0.3, y, 0}));
    scene.obstacles[2].mass = 0.1;
    const model::Model model = environment::Environment(scene).model;
    const ClothSystem cloth(model);
    SystemState now = start_of(model, cloth, 0);
    const CollisionStage stage(model, cloth, now);
    return stage.obstacle_turns_too_far(0, 0.1, now);
  };
  EXPECT_TRUE(turns_too_far(0.045));
  EXPECT_FALSE(turns_too_far(0.5));
}

}  // namespace
}  // namespace weft::simulation
