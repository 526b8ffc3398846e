#include "film/character/footing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "posed_mannequin.hpp"

namespace weft::character {
namespace {

/// A leg of a body that faces -y: thigh and shin of 0.4 m; the knee is bent by 0.4 rad; the ankle is 8 cm above the
/// sole.
Leg leg_at(const Vec3& hip) {
  Leg leg;
  leg.hip = hip;
  leg.knee = hip + 0.4 * Vec3(0, -std::sin(0.2), -std::cos(0.2));
  leg.ankle = leg.knee + 0.4 * Vec3(0, std::sin(0.2), -std::cos(0.2));
  leg.heel = leg.ankle - 0.08 * kUp;
  leg.ball = leg.heel + Vec3(0, -0.14, 0);
  leg.hinge = Vec3::UnitX();
  return leg;
}

const double kFloor = leg_at(Vec3::Zero()).heel.z();

struct Glide {
  std::vector<double> times;
  std::vector<Legs> legs;
  Footsteps steps;
};

/// Hips that move at 1 m/s; the feet move with them. `sunk`: depth below the floor [m]. The left foot is marked as
/// standing from 0.3 to 0.6 s.
Glide gliding(double sunk) {
  Glide walk;
  for (int k = 0; k <= 20; ++k) {
    walk.times.push_back(0.05 * k);
    const Vec3 at(0, -0.05 * k, -sunk);
    walk.legs.push_back({leg_at(at), leg_at(at + Vec3(-0.2, 0, 0))});
  }
  walk.steps.contacts[0] = {{6, 12}};
  return walk;
}

TEST(Footing, ABallThatStandsStaysOnTheFloorAndNothingSinksBelowIt) {
  for (const double sunk : {0.03, -0.02}) {
    const Glide walk = gliding(sunk);
    const auto stances = plant_feet(walk.legs, walk.steps, walk.times, kFloor, kUp);
    const Vec3 ball = walk.legs[6][0].ball + stances[6].shift[0];
    for (std::size_t k = 0; k < stances.size(); ++k) {
      const Vec3 left = walk.legs[k][0].ball + stances[k].shift[0], right = walk.legs[k][1].ball + stances[k].shift[1];
      EXPECT_EQ(stances[k].in_contact[0], k >= 6 && k <= 12);
      if (stances[k].in_contact[0]) {
        EXPECT_LT((left - ball).norm(), 1e-12) << k;
        EXPECT_NEAR(left.z(), kFloor, 1e-12) << k;
      }
      EXPECT_GE(left.z(), kFloor - 1e-12) << k;
      EXPECT_NEAR(right.z(), std::max(kFloor, kFloor - sunk), 1e-12) << k;
    }
    EXPECT_LT(stances[0].shift[0].head<2>().norm(), 1e-12) << "0.3 s before the contact the foot has its own way";
    EXPECT_GT(stances[5].shift[0].head<2>().norm(), 0.05) << "and right before it nearly that of the contact";
  }
}

TEST(Footing, HipsComeDownWhereALegDoesNotReach) {
  Glide walk = gliding(0);
  for (Legs& legs : walk.legs)
    for (Vec3* x : {&legs[0].hip, &legs[0].knee, &legs[0].ankle, &legs[0].heel, &legs[0].ball}) x->z() += 0.1;
  const auto stances = plant_feet(walk.legs, walk.steps, walk.times, kFloor, kUp);
  for (std::size_t k = 6; k <= 12; ++k) {
    Leg leg = walk.legs[k][0];
    const Vec3 ankle = leg.ankle + stances[k].shift[0];
    leg.hip += stances[k].rise * kUp;
    EXPECT_LE((ankle - leg.hip).norm(), 0.8) << k;
  }
  EXPECT_LT(stances[6].rise, -0.05);
  EXPECT_EQ(stances[20].rise, 0) << "0.4 s after it they are where they were";
}

TEST(Footing, ReachBringsTheAnkleThereAndBendsTheKneeForward) {
  Leg straight = leg_at(Vec3::Zero());
  straight.knee = Vec3(0, 0, -0.4);
  straight.ankle = Vec3(0, 0, -0.8);
  for (const Leg& leg : {leg_at(Vec3::Zero()), straight})
    for (const Vec3& ankle : {Vec3(0.1, -0.2, -0.6), Vec3(0, 0.3, -0.5), Vec3(-0.1, 0, -0.4)}) {
      const LegTurns turns = solve_two_bone_ik(leg, ankle);
      const Vec3 thigh = turns.upper * (leg.knee - leg.hip), shin = turns.lower * (leg.ankle - leg.knee);
      // Tolerance 1e-9 m: the law of cosines is inverted by an arc cosine, which amplifies rounding errors.
      EXPECT_LT((leg.hip + thigh + shin - ankle).norm(), 1e-9);
      EXPECT_GT(thigh.cross(shin).x(), 0);
    }
  // If the target is out of reach, the leg points toward it.
  const LegTurns turns = solve_two_bone_ik(straight, Vec3(0, -2, 0));
  EXPECT_LT((turns.lower * Vec3(0, 0, -1) - Vec3(0, -1, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace weft::character
