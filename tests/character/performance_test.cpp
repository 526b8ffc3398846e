#include "film/character/performance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::character {
namespace {

/// A node that moves by (3, 0, 1) in 2 s along a bent path, with one vertex at its origin; z is up.
struct Slider {
  Character body;
  Clip clip{"slide", 2, {}, {}};

  Slider() {
    body.nodes = {{"root", -1, Affine::Identity()}};
    body.bones = {{0, Affine::Identity()}};
    body.mesh.positions = {Vec3::Zero()};
    body.first_influence = {0, 1};
    body.influences = {{0, 1}};
    Channel channel;
    channel.position = {{0, 0.5, 2}, {Vec3(5, 0, 0), Vec3(6, 1, 0.2), Vec3(8, 0, 1)}};
    clip.channels = {channel};
  }

  Vec3 at(const Playing& playing, double t) const {
    return Performance(body, clip, playing, Vec3::UnitZ()).at(t).nodes[0].position;
  }
};

TEST(ClipTime, StandsThenGetsGoingSmoothlyThenRunsAtItsSpeed) {
  const Timing timing{1, 0.5, 0.25, 1.5};
  EXPECT_EQ(clip_time(timing, 0), 0.25);
  EXPECT_EQ(clip_time(timing, 1), 0.25);
  EXPECT_NEAR(clip_time(timing, 1.5), 0.25 + 1.5 * 0.25, 1e-15);
  EXPECT_NEAR(clip_time(timing, 3.5) - clip_time(timing, 1.5), 3, 1e-14);
  // Velocity and acceleration are continuous: by central differences, the velocity hardly changes across the ends of
  // the blend.
  const auto velocity = [&](double t, double h) {
    return (clip_time(timing, t + h) - clip_time(timing, t - h)) / (2 * h);
  };
  for (const double t : {1.0, 1.5}) EXPECT_NEAR(velocity(t + 1e-4, 1e-5), velocity(t - 1e-4, 1e-5), 1e-5) << t;
  EXPECT_NEAR(velocity(1, 1e-5), 0, 1e-7);
  EXPECT_NEAR(velocity(1.25, 1e-5), 0.75, 1e-6) << "half of the speed at half of the blend";
  EXPECT_NEAR(velocity(2, 1e-5), 1.5, 1e-9);
}

TEST(Performance, WithoutALoopStopsAtTheEndOfTheClip) {
  const Slider slider;
  EXPECT_EQ(slider.at({}, 2), Vec3(8, 0, 1));
  EXPECT_EQ(slider.at({}, 7), Vec3(8, 0, 1));
}

TEST(Performance, GoesOnWithEachRoundFromWhereTheLastHasComeToButNotUp) {
  const Slider slider;
  const Playing playing{.timing = {}, .loop = true};
  EXPECT_LT((slider.at(playing, 2 - 1e-12) - Vec3(8, 0, 1)).norm(), 1e-10);
  EXPECT_LT((slider.at(playing, 2) - Vec3(8, 0, 0)).norm(), 1e-12) << "the next round, at the height it began at";
  EXPECT_LT((slider.at(playing, 2.5) - Vec3(9, 1, 0.2)).norm(), 1e-12);
  EXPECT_LT((slider.at(playing, 6.5) - Vec3(15, 1, 0.2)).norm(), 1e-12);
  EXPECT_NEAR(Performance(slider.body, slider.clip, playing, Vec3::UnitZ()).gap(), 1, 1e-12);
}

TEST(Performance, WithACrossfadeDoesNotJump) {
  const Slider slider;
  const Playing playing{.timing = {}, .loop = true, .crossfade = 0.4};
  const Performance performance(slider.body, slider.clip, playing, Vec3::UnitZ());
  EXPECT_EQ(performance.gap(), 0);
  double largest = 0;
  constexpr double kStep = 1e-3;
  for (double t = 0; t < 8; t += kStep)
    largest =
        std::max(largest, (performance.at(t + kStep).nodes[0].position - performance.at(t).nodes[0].position).norm());
  // The clip alone moves by at most 2.9 m/s. The fade closes the gap of 1 m in 0.4 s; its largest speed is 1.5 times
  // its mean speed.
  EXPECT_LT(largest, (2.9 + 1.5 / 0.4) * kStep);
}

TEST(Performance, FromRestStandsInTheRestPoseAndStartsTheClipThere) {
  const Slider slider;
  const Playing playing{.timing = {1, 0.5, 0, 1}, .loop = false, .crossfade = 0, .stance = rest_pose(slider.body)};
  EXPECT_EQ(slider.at(playing, 0), Vec3(0, 0, 0));
  EXPECT_EQ(slider.at(playing, 1), Vec3(0, 0, 0));
  EXPECT_LT((slider.at(playing, 1 + 1e-6) - Vec3(0, 0, 0)).norm(), 1e-9) << "no jump";
  EXPECT_LT((slider.at(playing, 1.5 + 0.25) - Vec3(1, 1, 0.2)).norm(), 1e-12)
      << "the clip, shifted from (5, 0) to the rest";
}

// If a clip is repeated, all nodes that travel go on from where they are, not only the first one.
TEST(Performance, TakesAlongAllNodesThatTravel) {
  Slider slider;
  slider.body.nodes = {{"scene", -1, Affine::Identity()}, {"hips", 0, Affine::Identity()}};
  slider.body.nodes.push_back({"spine", 1, Affine::Identity()});
  slider.body.nodes.push_back({"foot", 0, Affine::Identity()});
  const Channel travel = slider.clip.channels[0];
  slider.clip.channels.assign(3, travel);
  for (Index n = 1; n <= 3; ++n) slider.clip.channels[static_cast<std::size_t>(n - 1)].node = n;
  const Performance performance(slider.body, slider.clip, {.timing = {}, .loop = true}, Vec3::UnitZ());
  const auto place = [&](double t, std::size_t node) -> Vec3 { return performance.at(t).nodes[node].position; };
  for (const std::size_t node : {std::size_t{1}, std::size_t{3}})
    EXPECT_LT((place(4.5, node) - Vec3(12, 1, 0.2)).norm(), 1e-12) << node;
  EXPECT_LT((place(4.5, 2) - Vec3(6, 1, 0.2)).norm(), 1e-12) << "the hips carry it";
}

TEST(Performance, TravelsWithTheSkinNotWithACameraBeforeIt) {
  Slider slider;
  slider.body.nodes = {{"camera", -1, Affine::Identity()}, {"root", -1, Affine::Identity()}};
  slider.body.bones[0].node = 1;
  slider.clip.channels[0].node = 1;
  Channel filming;
  filming.position = {{0, 2}, {Vec3::Zero(), Vec3(0, 7, 0)}};
  slider.clip.channels.push_back(filming);
  const Performance performance(slider.body, slider.clip, {.timing = {}, .loop = true}, Vec3::UnitZ());
  EXPECT_LT((performance.at(2.5).nodes[1].position - Vec3(9, 1, 0.2)).norm(), 1e-12);
}

TEST(Performance, TravelsAsFarAsARootAndTheHipsBelowItTogether) {
  Slider slider;
  slider.body.nodes = {{"root", -1, Affine::Identity()}, {"hips", 0, Affine::Identity()}};
  slider.body.bones[0].node = 1;
  slider.clip.channels[0].node = 1;
  Channel sliding;
  sliding.position = {{0, 2}, {Vec3::Zero(), Vec3(1, 0, 0)}};
  slider.clip.channels.push_back(sliding);
  const Performance performance(slider.body, slider.clip, {.timing = {}, .loop = true}, Vec3::UnitZ());
  const Vec3 hips = global_transforms(slider.body, performance.at(2))[1].translation();
  EXPECT_LT((hips - Vec3(9, 0, 0)).norm(), 1e-12) << "3 m by the hips, 1 m by the root";
}

TEST(Performance, TurnsTheTravelIntoTheDirectionsOfTheRootsParent) {
  Slider slider;
  Affine turned = Affine::Identity();
  turned.linear() = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()).toRotationMatrix();  // y of the clip points up
  slider.body.nodes = {{"scene", -1, turned}, {"root", 0, Affine::Identity()}};
  slider.clip.channels[0].node = 1;
  const Performance performance(slider.body, slider.clip, {.timing = {}, .loop = true}, Vec3::UnitZ());
  const auto world = [&](double t) -> Vec3 {
    return global_transforms(slider.body, performance.at(t))[1].translation();
  };
  // In the world, y of the clip is the height, which starts again in each repetition; -z of the clip is y.
  EXPECT_LT((world(2.5) - (world(0.5) + Vec3(3, -1, 0))).norm(), 1e-12);
}

TEST(Performance, TravelsInTheWorldAlsoIfTheClipTurnsTheRootsParent) {
  Slider slider;
  slider.body.nodes = {{"scene", -1, Affine::Identity()}, {"root", 0, Affine::Identity()}};
  slider.clip.channels[0].node = 1;
  Channel turning;
  turning.rotation = {{0, 2}, {Quat::Identity(), Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()))}};
  slider.clip.channels.push_back(turning);
  const Performance performance(slider.body, slider.clip, {.timing = {}, .loop = true}, Vec3::UnitZ());
  const auto world = [&](double t) -> Vec3 {
    return global_transforms(slider.body, performance.at(t))[1].translation();
  };
  EXPECT_LT((world(2 - 1e-12) - Vec3(0, 8, 1)).norm(), 1e-10) << "a quarter turn from x to y";
  EXPECT_LT((world(2) - Vec3(0, 8, 0)).norm(), 1e-12);
}

// Keys at 60 Hz have this rate, also for a short time within a clip of few keys.
TEST(KeyRate, IsThatOfTheDensestKeys) {
  Channel even, uneven;
  for (int k = 0; k <= 120; ++k) even.position.times.push_back(k / 60.0);
  EXPECT_EQ(key_rate({"even", 2, {even}, {}}), 60);
  uneven.rotation.times = {0, 5};
  for (int k = 1; k <= 30; ++k) uneven.rotation.times.push_back(5 + k / 60.0);
  uneven.rotation.times.push_back(20);
  EXPECT_NEAR(key_rate({"uneven", 20, {uneven}, {}}), 60, 5);
  EXPECT_EQ(key_rate({"pose", 0, {even}, {}}), 0);
}

}  // namespace
}  // namespace weft::character
