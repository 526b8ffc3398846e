#include "film/character/travel.hpp"

#include <gtest/gtest.h>

#include "film/character/footing.hpp"
#include "film/character/gait.hpp"
#include "film/character/mannequin.hpp"
#include "film/character/pose.hpp"
#include "posed_mannequin.hpp"

namespace weft::character {
namespace {

/// The mannequin and its walk from standing to standing.
class Travel : public testing::Test {
 protected:
  static constexpr double kWay = 4;  // [m]

  std::vector<Posture> postures(const Clip& clip) const {
    std::vector<Posture> postures;
    for (const double t : key_times(clip)) postures.push_back(skeleton_.at(pose_at(body_, clip, t)));
    return postures;
  }

  Vec3 hips(const Clip& clip, double t) const { return skeleton_.at(pose_at(body_, clip, t)).places[0]; }

  /// Largest slip [m] in `clip` of the ball of a foot, over the times in which this foot stands in `walk_`.
  double slip(const Clip& clip) const {
    const std::vector<double> times = key_times(clip);
    const Footsteps steps = find_footsteps(skeleton_, postures(walk_), key_times(walk_), kUp);
    const std::vector<Posture> at = postures(clip);
    double slip = 0;
    for (const bool right : {false, true})
      for (const Contact& contact : steps.contacts[right])
        for (std::size_t k = contact.first; k <= contact.last; ++k) {
          const std::size_t ball = joint_index(on_side(Joint::left_toes, right));
          slip = std::max(slip, (at[k].places[ball] - at[contact.first].places[ball]).norm());
        }
    return slip;
  }

  /// A clip of the length of `walk_` in the pose of its first keys.
  Clip standing() const {
    Clip clip = walk_;
    for (Channel& channel : clip.channels) {
      for (Quat& turned : channel.rotation.values) turned = channel.rotation.values.front();
      for (Vec3& place : channel.position.values) place = channel.position.values.front();
    }
    return clip;
  }

  const Character body_ = make_mannequin({.edge_length = 0.1});
  const std::vector<Index> joints_ = find_joints(body_);
  const Rig rig_{body_, joints_};
  const Skeleton skeleton_{rig_};
  const Clip walk_ = make_walk(body_, {.distance = kWay});
};

TEST_F(Travel, OfNoneLeavesTheBodyWhereItIs) {
  const Clip clip = remove_travel(rig_, walk_, kUp);
  ASSERT_GT((hips(walk_, walk_.duration) - hips(walk_, 0)).norm(), 0.9 * kWay);
  EXPECT_LT((hips(clip, walk_.duration) - hips(clip, 0)).norm(),
            1e-5);  // tolerance [m]: the last key is 2 µs before the end of the clip
  for (const double t : key_times(walk_)) {
    const Vec3 from_start = hips(clip, t) - hips(clip, 0);
    EXPECT_LT(std::hypot(from_start.x(), from_start.y()), 0.1) << t;  // [m]: the body sways by 5 cm
    EXPECT_NEAR(hips(clip, t).z(), hips(walk_, t).z(), 1e-9) << "heights stay";
  }
}

TEST_F(Travel, AtTheSpeedOfTheFeetMakesThemStand) {
  const Clip still = remove_travel(rig_, walk_, kUp);
  ASSERT_GT(slip(still), 0.5);
  const double mean = kWay / walk_.duration;
  const TravelResult traveled = set_travel_speed(rig_, still, mean, kUp);
  // Tolerance 10 %: measured 6 %, because the ball of the foot rolls before and after it stands.
  EXPECT_NEAR(traveled.feet, mean, 0.1 * mean);
  EXPECT_NEAR((hips(traveled.clip, walk_.duration) - hips(traveled.clip, 0)).norm(), kWay, 0.02 * kWay);
  EXPECT_LT(slip(traveled.clip), 0.05);
  EXPECT_GT((hips(walk_, walk_.duration) - hips(walk_, 0)).dot(hips(traveled.clip, walk_.duration)), 0) << "ahead";
}

TEST_F(Travel, TakesTheWayOfTheClipOutFirst) {
  const TravelResult once = set_travel_speed(rig_, remove_travel(rig_, walk_, kUp), 0.5, kUp),
                     twice = set_travel_speed(rig_, walk_, 0.5, kUp);
  for (const double t : {0.5, 1.5, walk_.duration})
    EXPECT_LT((hips(once.clip, t) - hips(twice.clip, t)).norm(), 0.05) << t;
}

// Rigs for animators have feet that are not descendants of the hips. They must travel with the hips.
TEST_F(Travel, TakesAlongWhatTravelsBesideTheHips) {
  const Index hip_node = joints_[joint_index(Joint::hips)];
  Character body = body_;
  body.nodes.push_back({"lantern", -1, Affine::Identity()});
  Clip walk = walk_;
  Channel beside;
  beside.node = static_cast<Index>(body.nodes.size() - 1);
  for (const Channel& channel : walk_.channels)
    if (channel.node == hip_node) beside.position = channel.position;
  ASSERT_FALSE(beside.position.times.empty());
  walk.channels.push_back(beside);
  const Rig rig{body, joints_};
  for (const Clip& clip : {remove_travel(rig, walk, kUp), set_travel_speed(rig, walk, 0.5, kUp).clip})
    for (const double t : {0.0, 1.5, walk.duration}) {
      const Pose pose = pose_at(body, clip, t);
      EXPECT_LT((pose.nodes.back().position - pose.nodes[hip_node].position).norm(), 1e-9) << t;
    }
}

// A clip on the spot moves only a node of the head. The hips must travel too, so that the head does not leave the body.
TEST_F(Travel, MovesTheHipsIfOnlyNodesBelowThemTravel) {
  Clip standing_clip = standing();
  const Index head = joints_[joint_index(Joint::head)];
  const Vec3 neck = body_.nodes[head].local.translation();
  for (Channel& channel : standing_clip.channels)
    if (channel.node == head) channel.position = {{0, standing_clip.duration}, {neck, neck + Vec3(0, 0, 0.01)}};
  const Clip clip = set_travel_speed(rig_, standing_clip, 0.5, kUp).clip;
  EXPECT_NEAR((hips(clip, standing_clip.duration) - hips(clip, 0)).norm(), 0.5 * standing_clip.duration, 1e-3);
}

TEST_F(Travel, OfASinglePoseLastsAsLongAsItsClip) {
  const Clip pose{"pose", 2, {}, {}};
  const Clip clip = set_travel_speed(rig_, pose, 0.5, kUp).clip;
  EXPECT_NEAR((hips(clip, 2) - hips(clip, 0)).norm(), 1, 1e-3);
}

// The clip may last longer for the sake of the face.
TEST_F(Travel, OfAClipLastsLongerThanItsKeys) {
  Channel still;
  still.rotation = {{0, 1}, {Quat::Identity(), Quat::Identity()}};
  const Clip clip = set_travel_speed(rig_, {"idle", 2, {still}, {}}, 0.5, kUp).clip;
  EXPECT_NEAR((hips(clip, 2) - hips(clip, 0)).norm(), 1, 1e-3);
}

TEST_F(Travel, GoesAheadWhereNoFeetTell) {
  const Clip standing_clip = standing();
  const TravelResult traveled = set_travel_speed(rig_, standing_clip, 0.5, kUp);
  EXPECT_EQ(traveled.feet, 0);
  const Vec3 displacement = hips(traveled.clip, standing_clip.duration) - hips(traveled.clip, 0);
  EXPECT_LT((displacement - 0.5 * standing_clip.duration * -Vec3::UnitY()).norm(),
            1e-3);  // tolerance [m]: hips and shoulders are level only within 0.01°
}

}  // namespace
}  // namespace weft::character
