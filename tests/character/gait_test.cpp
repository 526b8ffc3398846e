#include "film/character/gait.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "film/character/gait_curves.hpp"
#include "film/character/gait_steps.hpp"
#include "posed_mannequin.hpp"
#include "support/intersections.hpp"

namespace weft::character {
namespace {

const Character& mannequin() {
  static const Character body = make_mannequin({1.75, 1, 0, 0.03});
  return body;
}

std::size_t keys(const Clip& clip) {
  return clip.channels[0].rotation.times.size();
}

/// One stride of steady walking, between two strikes of the left heel. It is cut from the middle of a walk of 20 steps,
/// so that neither start nor end affects it.
Clip make_stride(const Character& body, double speed) {
  const Physique physique = physique_of(body);
  const Pace pace = pace_of(speed, physique.height);
  Walk walk{.speed = speed, .distance = 20 * pace.step_length};
  // The walk adjusts its steps to the distance. Choose the distance for which they have the step length of the pace.
  const StepPlan adjusted = plan_walk(physique, walk);
  walk.distance *= pace.step_length / (adjusted.speed * adjusted.key_time * adjusted.step_keys);
  const StepPlan plan = plan_walk(physique, walk);
  const auto first = static_cast<std::ptrdiff_t>(plan.footholds[0][6].strike);
  const auto cut = [&](auto& curve) {
    if (curve.times.empty()) return;
    const double start = curve.times[first];
    const auto keep = [&](auto& list) {
      list.erase(list.begin() + first + plan.period() + 1, list.end());
      list.erase(list.begin(), list.begin() + first);
    };
    keep(curve.times);
    keep(curve.values);
    for (double& time : curve.times) time -= start;
  };
  Clip clip = make_walk(body, walk);
  for (Channel& channel : clip.channels) {
    cut(channel.position);
    cut(channel.rotation);
  }
  clip.duration = plan.period() * plan.key_time;
  return clip;
}

Vec3 mirrored(const Vec3& p) {
  return p.cwiseProduct(Vec3(-1, 1, 1));
}

/// Positions of all joints at a key.
std::vector<Vec3> places(const Clip& clip, std::size_t key) {
  std::vector<Vec3> out;
  for (const Affine& joint : joints_at_key(mannequin(), clip, key)) out.emplace_back(joint.translation());
  return out;
}

const double kSpeeds[] = {0.7, 1.2, 1.5};

TEST(Gait, AWalkTooShortForTwoStepsHasShortStepsNotQuickOnes) {
  const Physique physique = physique_of(mannequin());
  for (const double distance : {1e-6, 0.1})
    for (const bool turn_back : {false, true}) {
      const Walk walk{.speed = 1.2, .distance = distance, .turn_back = turn_back};
      const StepPlan plan = plan_walk(physique, walk);
      EXPECT_NEAR(plan.key_time * plan.step_keys, pace_of(1.2, physique.height).step_time, 1e-12);
      for (const Channel& channel : make_walk(mannequin(), walk).channels) {
        for (const Quat& q : channel.rotation.values) EXPECT_TRUE(q.coeffs().allFinite());
        for (const Vec3& x : channel.position.values) EXPECT_TRUE(x.allFinite());
      }
    }
}

TEST(Gait, StrideIsPeriodicWithItsVelocity) {
  for (const double speed : kSpeeds) {
    const Clip clip = make_stride(mannequin(), speed);
    const std::size_t last = keys(clip) - 1;
    const Vec3 stride(0, -speed * clip.duration, 0);
    double jump = 0, usual = 0;
    const auto p = [&](std::size_t k) { return places(clip, k); };
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_LT((p(last)[j] - p(0)[j] - stride).norm(), 1e-9) << name(static_cast<Joint>(j));
      // From the last key to the first of the next stride, the velocity changes as little as between other keys.
      jump = std::max(jump, (p(1)[j] - p(0)[j] - (p(last)[j] - p(last - 1)[j])).norm());
    }
    for (std::size_t k = 1; k < last; ++k) {
      const auto before = p(k - 1), here = p(k), after = p(k + 1);
      for (std::size_t j = 0; j < kJointCount; ++j) {
        usual = std::max(usual, (after[j] - 2 * here[j] + before[j]).norm());
      }
    }
    EXPECT_LT(jump, 1.01 * usual) << speed;
  }
}

TEST(Gait, RightSideDoesHalfAStrideLaterWhatTheLeftDid) {
  const Clip clip = make_stride(mannequin(), 1.2);
  const std::size_t half = (keys(clip) - 1) / 2;
  const Vec3 step(0, -1.2 * clip.duration / 2, 0);
  for (std::size_t k = 0; k <= half; k += 3) {
    const auto now = places(clip, k), later = places(clip, k + half);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const std::size_t other = j < 5 ? j : j < 13 ? j + kSideJointCount : j - kSideJointCount;
      EXPECT_LT((later[other] - mirrored(now[j]) - step).norm(), 1e-9) << name(static_cast<Joint>(j)) << ' ' << k;
    }
  }
}

TEST(Gait, HasTheSpeedAskedForAndStepsOfConstantWalkRatio) {
  double first_ratio = 0;
  for (const double speed : kSpeeds) {
    const Clip clip = make_stride(mannequin(), speed);
    const double travelled = places(clip, 0)[0].y() - places(clip, keys(clip) - 1)[0].y();
    EXPECT_NEAR(travelled / clip.duration, speed, 1e-9);
    const double ratio = (travelled / 2) / (120 / clip.duration);  // walk ratio [m/(steps/min)]
    EXPECT_NEAR(ratio, 0.0065, 0.0005);
    if (first_ratio == 0) first_ratio = ratio;
    EXPECT_NEAR(ratio, first_ratio, 1e-12);
  }
}

/// `slip`: largest slip [m] of any vertex while it is in contact, less than a millimetre above the floor. `lowest`:
/// minimum height of all vertices [m]. `period` [s]: duration of a stride that begins with a strike of the left foot;
/// vertices count only while their foot stands. If `period` is 0, these times are unknown, and vertices that pass close
/// above the floor count too.
struct FootAtRest {
  double slip = 0, lowest = 1;
};
FootAtRest contact_of(const Clip& clip, double period) {
  const Character& body = mannequin();
  FootAtRest worst;
  std::vector<Vec3> before;
  std::vector<double> slip(body.mesh.positions.size(), 0);
  for (std::size_t k = 0; k < keys(clip); ++k) {
    const auto now = skinned(body, joints_at_key(body, clip, k));
    const double phase = period > 0 ? clip.channels[0].rotation.times[k] / period : 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
      worst.lowest = std::min(worst.lowest, now[v].z());
      const double strides_since_strike =
          now[v].x() == 0 ? 0 : std::fmod(phase + (body.mesh.positions[v].x() > 0 ? 0 : 0.5), 1);
      const bool stands = period == 0 || strides_since_strike <= kStance;
      if (!before.empty() && stands && now[v].z() < 1e-3 && before[v].z() < 1e-3) {
        slip[v] += (now[v] - before[v]).head<2>().norm();
        worst.slip = std::max(worst.slip, slip[v]);
      } else {
        slip[v] = 0;
      }
    }
    before = now;
  }
  return worst;
}

TEST(Gait, FeetNeitherSlideNorSink) {
  for (const double speed : kSpeeds) {
    const Clip clip = make_stride(mannequin(), speed);
    const FootAtRest worst = contact_of(clip, clip.duration);
    EXPECT_LT(worst.slip, 0.005) << speed;
    EXPECT_GT(worst.lowest, -0.003) << speed;
  }
}

// Starts, turns and ends have small steps. Measured slip: 1.7 mm of a standing foot. Vertices that pass close above the
// floor while the foot is set down count too: 5.1 mm at most.
TEST(Gait, FeetDoNotSlideFromStandingThroughATurnToStanding) {
  for (const double speed : kSpeeds) {
    const Walk walk{.speed = speed, .distance = 2.5, .turn_back = true};
    const FootAtRest worst = contact_of(make_walk(mannequin(), walk), 0);
    EXPECT_LT(worst.slip, 0.006) << speed;
    EXPECT_GT(worst.lowest, -0.003) << speed;
  }
}

/// Flexion of a knee [degrees], negative if it bends forward.
double flexion(const Clip& clip, std::size_t key, Joint hip) {
  const auto joints = joints_at_key(mannequin(), clip, key);
  const auto at = [&](std::size_t next) { return Vec3(joints[joint_index(hip) + next].translation()); };
  const Vec3 thigh = at(1) - at(0), shin = at(2) - at(1);
  // Seen from the left (+x), a shin bent back is turned counter-clockwise relative to the thigh.
  return std::atan2(thigh.cross(shin).x(), thigh.dot(shin)) / kDegree;
}

// Source: Perry, "Normal Gait" (Atlas of Limb Prosthetics, 1992, ch. 13). Measured: the mannequin at 0.7, 1.2, 1.5 m/s.
//   heel contact      5°          4.8 to 5.0°
//   loading response  15 to 20°   16.7, 19.8, 22.6°
//   terminal stance   5°          6.6, 6.9, 6.9°
//   toe-off           40°         25, 30, 31° (lower, because the mannequin's toes are short)
//   initial swing     60°         54, 60, 60°
TEST(Gait, KneesBendAsMeasuredOnPeople) {
  for (const double speed : kSpeeds) {
    const Clip clip = make_stride(mannequin(), speed);
    const double last = static_cast<double>(keys(clip) - 1);
    double loading = 0, late = 0, terminal = 90, off = 0, swing = 0, min_flexion = 90;
    for (std::size_t k = 0; k < keys(clip); ++k) {
      const double phase = static_cast<double>(k) / last, bend = flexion(clip, k, Joint::left_upper_leg);
      min_flexion = std::min(min_flexion, bend);
      if (phase < 0.2) loading = std::max(loading, bend);
      if (phase > 0.3 && phase < 0.5) terminal = std::min(terminal, bend);
      if (phase <= kStance) off = bend;
      if (phase > kStance) swing = std::max(swing, bend);
      if (phase > 0.2 && phase < 0.5) late = std::max(late, bend);
    }
    EXPECT_NEAR(flexion(clip, 0, Joint::left_upper_leg), 5, 1) << speed;
    EXPECT_GT(loading, 15) << speed;
    EXPECT_LT(loading, 24) << speed;
    EXPECT_LT(late, 19) << speed;
    EXPECT_NEAR(terminal, 5, 3) << speed;
    EXPECT_NEAR(off, 32, 9) << speed;
    EXPECT_NEAR(swing, 60, 8) << speed;
    EXPECT_GT(min_flexion, 3) << speed << ": snaps straight";
  }
}

TEST(Gait, WeightGoesToTheStandingLegBeforeTheFirstStep) {
  const Clip clip = make_walk(mannequin(), {.speed = 1.15});
  const auto start = places(clip, 0);
  std::size_t lift = 0;
  const std::size_t foot = joint_index(Joint::right_foot);
  while (places(clip, lift)[foot].z() < start[foot].z() + 0.05) ++lift;
  const auto then = places(clip, lift);
  EXPECT_GT(then[0].x() - start[0].x(), 0.02);
  EXPECT_LT(then[0].y() - start[0].y(), -0.05) << "leans into the step";
  // Smooth start: the acceleration of the hips stays below 4 m/s² in the whole first step.
  for (std::size_t k = 1; k < lift + 40; ++k) {
    const double h = clip.channels[0].rotation.times[1];
    const Vec3 bend = places(clip, k + 1)[0] - 2 * places(clip, k)[0] + places(clip, k - 1)[0];
    EXPECT_LT(bend.head<2>().norm() / (h * h), 4) << k;
  }
}

TEST(Gait, HeadLeadsTheChestAndTheChestTheHipsIntoATurn) {
  const Clip clip = make_walk(mannequin(), {.turn_back = true});
  const auto when_across = [&](Joint joint) {
    for (std::size_t k = 0; k < keys(clip); ++k) {
      const Vec3 forward = joints_at_key(mannequin(), clip, k)[joint_index(joint)].linear() * -Vec3::UnitY();
      if (forward.y() > 0) return clip.channels[0].rotation.times[k];
    }
    return 0.0;
  };
  const double head = when_across(Joint::head), chest = when_across(Joint::chest), hips = when_across(Joint::hips);
  EXPECT_LT(head + 0.1, chest);
  EXPECT_LT(chest + 0.05, hips);
  EXPECT_LT(hips, head + 0.5);
}

TEST(Gait, ArmsAndLegsLeaveRoomForCloth) {
  const Clip clip = make_stride(mannequin(), 1.2);
  const Character& body = mannequin();
  double arm = 1, legs = 1;
  for (std::size_t k = 0; k < keys(clip); k += 4) {
    const auto posed = skinned(body, joints_at_key(body, clip, k));
    std::vector<Vec3> lower_arm, trunk, left, right;
    for (std::size_t v = 0; v < posed.size(); ++v) {
      const Vec3& rest = body.mesh.positions[v];
      const auto weight = [&](Joint joint) { return weight_of(body, v, joint); };
      if (weight(Joint::left_lower_arm) + weight(Joint::left_hand) > 0.5) lower_arm.push_back(posed[v]);
      if (std::abs(rest.x()) < 0.19 && rest.z() < 1.2) trunk.push_back(posed[v]);
      if (rest.z() < 0.7 && rest.x() != 0) (rest.x() > 0 ? left : right).push_back(posed[v]);
    }
    for (const Vec3& p : lower_arm) {
      for (const Vec3& q : trunk) arm = std::min(arm, (p - q).norm());
    }
    for (const Vec3& p : left) {
      for (const Vec3& q : right) legs = std::min(legs, (p - q).norm());
    }
  }
  EXPECT_GT(arm, 0.05);
  EXPECT_GT(legs, 0.01);
}

TEST(Gait, BodyOfAnyBuildDoesNotCutItselfWhileItWalks) {
  const MannequinBuild builds[] = {{1.75, 1, 0, 0.025}, {1.6, 0.9, 0, 0.03}, {1.9, 1.3, 0, 0.03}, {1.8, 1, 1, 0.03}};
  for (const MannequinBuild& build : builds) {
    const Character body = make_mannequin(build);
    const Clip clip = make_stride(body, 1.2);
    for (std::size_t k = 0; k < keys(clip); k += 5) {
      const auto posed = skinned(body, joints_at_key(body, clip, k));
      const support::TestedObject object{"body", true, posed, body.mesh.topology.triangles};
      EXPECT_TRUE(support::find_intersections(std::span(&object, 1)).pairs.empty()) << build.height << ' ' << k;
    }
  }
}

TEST(Gait, LegsDoNotCutEachOtherInTheTurn) {
  const Clip clip = make_walk(mannequin(), {.speed = 1.15, .distance = 2, .turn_back = true});
  for (std::size_t k = 0; k < keys(clip); k += 6) {
    const auto posed = skinned(mannequin(), joints_at_key(mannequin(), clip, k));
    const support::TestedObject object{"body", true, posed, mannequin().mesh.topology.triangles};
    EXPECT_TRUE(support::find_intersections(std::span(&object, 1)).pairs.empty())
        << clip.channels[0].rotation.times[k] << " s";
  }
}

TEST(Gait, WalkStartsAndEndsStillAndTurnsRound) {
  const Clip clip = make_walk(mannequin(), {.distance = 3, .turn_back = true});
  const std::size_t last = keys(clip) - 1;
  const auto start = places(clip, 0), second = places(clip, 1), end = places(clip, last);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((second[j] - start[j]).norm(), 1e-4);
    EXPECT_LT((end[j] - places(clip, last - 1)[j]).norm(), 1e-4);
    // After the walk there and back the body stands at its start, turned by half a turn.
    const Vec3 turned(-start[j].x(), -start[j].y(), start[j].z());
    EXPECT_LT((end[j] - turned).norm(), 1e-3) << name(static_cast<Joint>(j));
  }
  double farthest = 0, lowest = 1, bend = 0;
  for (std::size_t k = 1; k < last; ++k) {
    const auto before = places(clip, k - 1), here = places(clip, k), after = places(clip, k + 1);
    farthest = std::max(farthest, -here[0].y());
    for (std::size_t j = 0; j < kJointCount; ++j) {
      bend = std::max(bend, (after[j] - 2 * here[j] + before[j]).norm());
    }
    if (k % 5 == 0) {
      for (const Vec3& p : skinned(mannequin(), joints_at_key(mannequin(), clip, k))) lowest = std::min(lowest, p.z());
    }
  }
  EXPECT_NEAR(farthest, 3, 0.05);
  EXPECT_GT(lowest, -0.003);
  // There are no jumps. Measured second differences between keys: 0.025 m where a knee straightens, 0.015 m where a
  // foot touches down.
  EXPECT_LT(bend, 0.04);
}

TEST(Gait, IsTheSameEveryTime) {
  const Clip a = make_walk(mannequin(), {}), b = make_walk(mannequin(), {});
  ASSERT_EQ(keys(a), keys(b));
  for (std::size_t c = 0; c < a.channels.size(); ++c) {
    for (std::size_t k = 0; k < keys(a); ++k) {
      EXPECT_EQ(a.channels[c].rotation.values[k].coeffs(), b.channels[c].rotation.values[k].coeffs());
    }
  }
}

}  // namespace
}  // namespace weft::character
