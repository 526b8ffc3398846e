#include "physics/motion/track.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "film/scene/common_rules.hpp"
#include "motion/rotation.hpp"

namespace weft::motion {
namespace {

// Tolerance: rounding errors of products of a few unit quaternions [rad].
constexpr double kRoundingOfTurns = 1e-13;

/// Angle between two rotations [rad], accurate for small angles too.
double between(const Quat& a, const Quat& b) {
  const Quat d = a * b.conjugate();
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

PoseTrack tumbling(Interpolation interpolation) {
  return {interpolation,
          {{0.0, {{0, 0, 0}, Quat::Identity()}},
           {0.7, {{1, 0, 0.5}, about({0, 0, 1}, 1.2)}},
           {1.0, {{1, 2, 0}, about({1, 2, -1}, 2.9)}},
           {2.4, {{-1, 1, 3}, about({-1, 0.3, 0.2}, 2.0)}},
           {3.0, {{0, 0, 1}, about({0, 1, 0}, -0.4)}}}};
}

/// Rotation about one axis through the given angles [rad].
PoseTrack spin(Interpolation interpolation, const Vec3& axis, const std::vector<double>& times,
               const std::vector<double>& angles) {
  PoseTrack track{interpolation, {}};
  for (std::size_t i = 0; i < times.size(); ++i)
    track.keys.push_back({times[i], {Vec3::Zero(), about(axis, angles[i])}});
  return track;
}

TEST(Pose, BestRotationIsFoundThroughStretchAndIsNoMirrorImage) {
  const Mat3 turn = about({1, 2, 3}, 0.7).toRotationMatrix();
  EXPECT_LT((best_rotation(turn * Vec3(1.2, 0.9, 1).asDiagonal()) - turn).norm(), kRoundingOfTurns);
  // In a mirror image, the axis with the smallest stretch is the one that is not mirrored.
  EXPECT_LT((best_rotation(turn * Vec3(3, 2, -1).asDiagonal()) - turn).norm(), kRoundingOfTurns);
}

TEST(Track, WithoutKeysHoldsTheRestPose) {
  const Pose rest{{1, 2, 3}, about({1, 1, 0}, 0.5)};
  const Track track({}, rest);
  EXPECT_FALSE(track.is_moving());
  for (const double t : {-1.0, 0.0, 100.0}) {
    const PoseSample pose = track.at(t);
    EXPECT_EQ(pose.position, rest.position);
    EXPECT_LT(between(pose.rotation, rest.rotation), kRoundingOfTurns);
    EXPECT_EQ(pose.velocity, Vec3(0, 0, 0));
    EXPECT_EQ(pose.angular_velocity, Vec3(0, 0, 0));
  }
}

TEST(Track, OfOneKeyHoldsItInsteadOfTheRestPose) {
  const Track track({Interpolation::cubic, {{1, {{4, 5, 6}, about({0, 0, 1}, 1)}}}}, {{1, 2, 3}, Quat::Identity()});
  EXPECT_FALSE(track.is_moving());
  for (const double t : {0.0, 1.0, 2.0}) {
    EXPECT_EQ(track.at(t).position, Vec3(4, 5, 6));
    EXPECT_LT(between(track.at(t).rotation, about({0, 0, 1}, 1)), kRoundingOfTurns);
  }
}

class Tracks : public testing::TestWithParam<Interpolation> {};

TEST_P(Tracks, PassThroughTheirKeysFromBothSides) {
  const PoseTrack keys = tumbling(GetParam());
  const Track track(keys);
  for (const auto& key : keys.keys) {
    for (const double t : {key.time, key.time - 1e-14}) {
      const PoseSample pose = track.at(t);
      EXPECT_LT((pose.position - key.pose.position).norm(), 10 * kRoundingOfTurns);
      EXPECT_LT(between(pose.rotation, key.pose.rotation), 10 * kRoundingOfTurns);
      EXPECT_NEAR(pose.rotation.norm(), 1, kRoundingOfTurns);
    }
  }
}

TEST_P(Tracks, RestBeforeTheFirstAndFromTheLastKeyOn) {
  const PoseTrack keys = tumbling(GetParam());
  const Track track(keys);
  EXPECT_TRUE(track.is_moving());
  EXPECT_NE(track.at(0.0).angular_velocity.norm(), 0);
  for (const double t : {-1e-11, -7.0, 3.0, 50.0}) {
    const PoseSample pose = track.at(t);
    const Pose& end = (t < 0 ? keys.keys.front() : keys.keys.back()).pose;
    EXPECT_EQ(pose.position, end.position);
    EXPECT_LT(between(pose.rotation, end.rotation), kRoundingOfTurns);
    for (const Vec3& rate : {pose.velocity, pose.acceleration, pose.angular_velocity, pose.angular_acceleration})
      EXPECT_EQ(rate, Vec3(0, 0, 0));
  }
}

TEST_P(Tracks, HaveTheVelocitiesAndAccelerationsThatABodyPointShows) {
  const Track track(tumbling(GetParam()));
  const Vec3 body(0.3, -0.8, 0.5);
  const auto place = [&](double t) -> Vec3 {
    const PoseSample pose = track.at(t);
    return pose.position + pose.rotation * body;
  };
  // Tolerances: central differences have errors of h²/6 times the third derivative (velocity) and h²/12 times the
  // fourth derivative (acceleration), which are below 1e4 m/s³ and 2e5 m/s⁴ at turning rates of 10 rad/s, plus rounding
  // errors of 1e-15 / h and 4e-15 / h².
  const double h = 1e-4;
  for (const double t : {0.05, 0.35, 0.69, 0.71, 0.85, 0.99, 1.01, 1.7, 2.39, 2.5, 2.9}) {
    const PoseSample pose = track.at(t);
    const Vec3 arm = pose.rotation * body;
    const Vec3 velocity = (place(t + h) - place(t - h)) / (2 * h);
    const Vec3 acceleration = (place(t + h) - 2 * place(t) + place(t - h)) / (h * h);
    EXPECT_LT((pose.velocity_at(arm) - velocity).norm(), 2e-5) << t;
    EXPECT_LT((pose.acceleration_at(arm) - acceleration).norm(), 2e-4) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(Interpolations, Tracks, testing::Values(Interpolation::linear, Interpolation::cubic),
                         [](const auto& way) { return way.param == Interpolation::linear ? "linear" : "cubic"; });

TEST(LinearTrack, TurnsEvenlyTheShortestWay) {
  // From 170° to -170° the body turns by 20°, not by 340°. A negated quaternion is the same rotation.
  PoseTrack keys = spin(Interpolation::linear, {0, 0, 1}, {0, 2}, {170 * kDegree, -170 * kDegree});
  for (const bool negated : {false, true}) {
    if (negated) keys.keys[1].pose.rotation.coeffs() *= -1;
    const PoseSample pose = Track(keys).at(0.5);
    EXPECT_LT(between(pose.rotation, about({0, 0, 1}, 175 * kDegree)), kRoundingOfTurns);
    EXPECT_LT((pose.angular_velocity - Vec3(0, 0, 10 * kDegree)).norm(), kRoundingOfTurns);
    EXPECT_EQ(pose.angular_acceleration, Vec3(0, 0, 0));
  }
}

TEST(Track, TurnsByAllOfTheChangeOfOneAngle) {
  // Three turns about x; 290 degrees about y (the longer way); 2.5 turns backward about z. The other two angles are
  // constant, and tilt the axis.
  const double change[3] = {1080, 290, -900};
  const Vec3 held(20, -40, 70);
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto key = [&](double time, double share) {
        Vec3 angles = held;
        angles[axis] += share * change[axis];
        return PoseKey{time, {Vec3::Zero(), scene::from_angles(angles), angles}};
      };
      const Track track({interpolation, {key(0, 0), key(0.5, 0.25), key(2, 1)}});
      for (const double t : {0.0, 0.2, 0.5, 0.8, 1.1, 1.7, 1.99}) {
        EXPECT_LT(between(track.at(t).rotation, key(t, t / 2).pose.rotation), 1e-11) << axis << ' ' << t;
        EXPECT_NEAR(track.at(t).angular_velocity.norm(), std::abs(change[axis]) / 2 * kDegree, 1e-10) << axis;
      }
    }
  }
}

TEST(CubicTrack, ThroughEvenTurnsAboutOneAxisSpinsEvenly) {
  const Vec3 axis(1, -2, 0.5);
  const Track track(spin(Interpolation::cubic, axis, {0, 1, 1.5, 4}, {0, 1, 1.5, 4}));
  for (const double t : {0.0, 0.3, 1.0, 1.2, 2.5, 3.9}) {
    EXPECT_LT(between(track.at(t).rotation, about(axis, t)), kRoundingOfTurns);
    EXPECT_LT((track.at(t).angular_velocity - axis.normalized()).norm(), 10 * kRoundingOfTurns);
    EXPECT_LT(track.at(t).angular_acceleration.norm(), 10 * kRoundingOfTurns);
  }
}

TEST(CubicTrack, AboutOneAxisIsTheSplineOfTheAngle) {
  const std::vector<double> times{0, 0.4, 1, 3, 3.2}, angles{0, 2, -1, 1.5, 1.7};
  const Track track(spin(Interpolation::cubic, {0, 1, 0}, times, angles));
  std::vector<Spline<1>::Value> values;
  for (const double angle : angles) values.push_back(Spline<1>::Value(angle));
  const Spline<1> spline(Interpolation::cubic, times, values);
  for (double t = 0.01; t < 3.2; t += 0.07) {
    EXPECT_LT(between(track.at(t).rotation, about({0, 1, 0}, spline.at(t).value[0])), 10 * kRoundingOfTurns) << t;
    EXPECT_NEAR(track.at(t).angular_velocity.y(), spline.at(t).first_derivative[0], 100 * kRoundingOfTurns) << t;
    EXPECT_NEAR(track.at(t).angular_acceleration.y(), spline.at(t).second_derivative[0], 1000 * kRoundingOfTurns) << t;
  }
}

TEST(CubicTrack, HasContinuousVelocityAndAngularVelocityAtItsKeys) {
  const Track track(tumbling(Interpolation::cubic));
  for (const double t : {0.7, 1.0, 2.4}) {
    const PoseSample before = track.at(std::nextafter(t, 0)), after = track.at(t);
    EXPECT_LT((before.velocity - after.velocity).norm(), 100 * kRoundingOfTurns);
    EXPECT_LT((before.angular_velocity - after.angular_velocity).norm(), 100 * kRoundingOfTurns);
  }
}

TEST(Track, GoesOnThroughHalfTurnsInTheSameDirection) {
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    for (const double way : {1.0, -1.0}) {
      const double quarter = way * 90 * kDegree;
      // From the second key to the third, the body rotates by half a turn plus 1e-9 rad. The shortest rotation between
      // these keys is in the opposite direction.
      const double more = 3 * quarter + way * 1e-9;
      const Track track(spin(interpolation, {0, 0, 1}, {0, 1, 3, 5, 7}, {0, quarter, more, 5 * quarter, 7 * quarter}));
      for (const double t : {0.5, 1.5, 2.5, 4.0, 6.5})
        EXPECT_LT((track.at(t).angular_velocity - Vec3(0, 0, quarter)).norm(), 1e-8) << t;
    }
  }
}

}  // namespace
}  // namespace weft::motion
