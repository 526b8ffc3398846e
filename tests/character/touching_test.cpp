// Hands that touch each other, an elbow or the hips.
#include "film/character/touching.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace weft::character {
namespace {

constexpr double kRoundingOfPlaces = 1e-12;

/// Joint positions of a body that faces -y, z up. Its arms of 0.3 and 0.25 m end at the given hands.
Places standing(const Vec3& left_hand, const Vec3& right_hand) {
  Places places;
  places.fill(Vec3::Zero());
  for (const bool right : {false, true}) {
    const double side = right ? -1 : 1;
    const auto at = [&](Joint left) -> Vec3& { return places[joint_index(on_side(left, right))]; };
    at(Joint::left_upper_leg) = {0.1 * side, 0, 0.9};
    at(Joint::left_upper_arm) = {0.18 * side, 0, 1.4};
    at(Joint::left_lower_arm) = {0.35 * side, 0.02, 1.15};
    at(Joint::left_hand) = right ? right_hand : left_hand;
  }
  return places;
}

std::array<bool, kJointCount> all() {
  std::array<bool, kJointCount> both;
  both.fill(true);
  return both;
}

std::size_t hand(bool right) {
  return joint_index(on_side(Joint::left_hand, right));
}

const Proportions kLarger{1.2, 1.1, 0.55};

TEST(Touching, HandsThatAreTogetherComeTogetherInTheMiddleBetweenThem) {
  const Places theirs = standing({0.04, -0.4, 1.2}, {-0.04, -0.4, 1.18});
  const Places ours = standing({0.15, -0.4, 1.2}, {-0.05, -0.45, 1.3});
  const auto pull = displace_hands(theirs, ours, all(), kLarger, {0, 0});
  const Vec3 left = ours[hand(false)] + pull[0], right = ours[hand(true)] + pull[1];
  EXPECT_LT((left - right - 1.2 * (theirs[hand(false)] - theirs[hand(true)])).norm(), kRoundingOfPlaces);
  EXPECT_LT((pull[0] + pull[1]).norm(), kRoundingOfPlaces);
}

TEST(Touching, HandsThatAreFarFromAllStayWhereTheyAre) {
  const Places theirs = standing({0.3, -0.4, 1.2}, {-0.3, -0.4, 1.2}), ours = standing({0.2, 0, 1}, {-0.2, 0, 1});
  for (const Vec3& pull : displace_hands(theirs, ours, all(), kLarger, {0, 0})) EXPECT_EQ(pull, Vec3(Vec3::Zero()));
}

TEST(Touching, AHandOnTheHipStaysThereIfItRestsAndItsArmIsBent) {
  const Vec3 on_hip(0.18, 0, 0.98), away(-0.4, -0.4, 1.3);
  const Places theirs = standing(on_hip, away), ours = standing({0.3, 0, 0.9}, away);
  const Vec3 middle(0, 0, 0.9);
  const auto rests = displace_hands(theirs, ours, all(), kLarger, {1, 0});
  EXPECT_LT((ours[hand(false)] + rests[0] - (middle + 1.1 * (on_hip - middle))).norm(), kRoundingOfPlaces);
  EXPECT_EQ(displace_hands(theirs, ours, all(), kLarger, {0, 0})[0], Vec3(Vec3::Zero())) << "it passes";
  Places hanging = theirs;
  hanging[joint_index(Joint::left_lower_arm)] = 0.5 * (hanging[joint_index(Joint::left_upper_arm)] + on_hip);
  EXPECT_EQ(displace_hands(hanging, ours, all(), kLarger, {1, 0})[0], Vec3(Vec3::Zero())) << "it hangs";
}

TEST(Touching, ComesAndGoesWithoutAJump) {
  const Places ours = standing({0.2, -0.4, 1.2}, {-0.2, -0.4, 1.2});
  Vec3 last = Vec3::Zero();
  for (int k = 400; k >= 0; --k) {
    const double gap = 1e-3 * k;
    const auto pull =
        displace_hands(standing({gap / 2, -0.4, 1.2}, {-gap / 2, -0.4, 1.2}), ours, all(), kLarger, {0, 0});
    // No jump. The displacement is w(g) (0.6 g - 0.2 m) for the gap g and the weight w, which fades from 1 to 0 between
    // gaps of 0.132 and 0.264 m, with a slope of up to 11.4 1/m: it grows by at most 1.4 mm per millimetre of the gap.
    EXPECT_LT((pull[0] - last).norm(), 1.5e-3) << gap;
    last = pull[0];
  }
  EXPECT_LT((last - Vec3(-0.2, 0, 0)).norm(), kRoundingOfPlaces);
}

TEST(Touching, WithoutAnElbowAnArmDoesNotMove) {
  auto both = all();
  both[joint_index(Joint::left_lower_arm)] = false;
  const Places theirs = standing({0.04, -0.4, 1.2}, {-0.04, -0.4, 1.2}), ours = standing({0.2, 0, 1}, {-0.2, 0, 1});
  const auto pull = displace_hands(theirs, ours, both, kLarger, {0, 0});
  EXPECT_EQ(pull[0], Vec3(Vec3::Zero()));
  EXPECT_GT(pull[1].norm(), 0.1);
}

// A hand that rests on the hips for a second follows their rotation; later the hand swings freely.
TEST(Touching, HandsRestWhereTheyStayAgainstTheHips) {
  std::vector<Posture> postures;
  std::vector<double> times;
  for (int k = 0; k <= 40; ++k) {
    const double t = 0.05 * k;
    const Quat turn(Eigen::AngleAxisd(2 * t, Vec3::UnitZ()));
    Posture posture;
    posture.places.fill(Vec3::Zero());
    posture.ends.fill(Vec3::Zero());
    posture.rotations.fill(Quat::Identity());
    posture.knuckles.fill(Vec3::Zero());
    posture.places[0] = Vec3(t, 0, 1);
    posture.rotations[0] = turn;
    const Vec3 swing(0, t > 1 ? 0.3 * std::sin(6 * (t - 1)) : 0, 0);
    for (const bool right : {false, true})
      posture.places[hand(right)] = posture.places[0] + turn * (Vec3(0.2, 0, 0) + swing);
    postures.push_back(posture);
    times.push_back(t);
  }
  const auto rests = find_resting_hands(postures, times, 0.55);
  for (std::size_t k = 0; k + 3 < 20; ++k) EXPECT_EQ(rests[k], (std::array<double, 2>{1, 1})) << times[k];
  EXPECT_EQ(rests[21][0], 0) << "1.8 m/s";
}

}  // namespace
}  // namespace weft::character
