#include "film/character/touching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::character {
namespace {

// Distances of the wrist from its targets [arm lengths; 0.55 m in an adult]. Up to these distances, a contact has full
// weight; up to twice these distances, its weight fades to 0. Measured on adults: 2.5 to 6 cm from the midpoint of the
// wrists if the hands are joined, 8 to 13 cm from an elbow that the hand holds, 17 to 22 cm from the midpoint of the
// hip joints if the hand is on a hip.
constexpr double kHandsDistance = 0.12, kElbowDistance = 0.2, kHipsDistance = 0.4;
// An arm hangs if it is bent by less than kHangingBend; it reaches for something if bent by more than kReachingBend
// [rad].
constexpr double kHangingBend = 40 * std::numbers::pi / 180, kReachingBend = 70 * std::numbers::pi / 180;

// A hand rests on the hips if it moves relative to them by less than kMaxRestMotion [arm lengths] within kRestTime [s]
// before and after: 5 cm within 0.1 s before and after. In walking and running, hands move by 20 to 60 cm in 0.2 s.
constexpr double kMaxRestMotion = 0.09, kRestTime = 0.1;

/// Computes the displacement of a hand; see displace_hands().
class HandDisplacement {
 public:
  HandDisplacement(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                   const Proportions& proportions)
      : theirs_(theirs), ours_(ours), both_(both), proportions_(proportions) {}

  Vec3 compute(bool right, double rests) {
    const auto at = [&](Joint left) { return joint_index(on_side(left, right)); };
    const auto across = [&](Joint left) { return joint_index(on_side(left, !right)); };
    const std::size_t shoulder = at(Joint::left_upper_arm), elbow = at(Joint::left_lower_arm);
    hand_ = at(Joint::left_hand);
    if (!both_[shoulder] || !both_[elbow] || !both_[hand_]) return Vec3::Zero();
    sum_.setZero();
    weights_ = 0;
    const Vec3 upper = theirs_[elbow] - theirs_[shoulder], lower = theirs_[hand_] - theirs_[elbow];
    const double bent = ease((angle_between(upper, lower) - kHangingBend) / (kReachingBend - kHangingBend));
    add_target(hand_, across(Joint::left_hand), 0.5, kHandsDistance, proportions_.arm);
    add_target(across(Joint::left_lower_arm), across(Joint::left_lower_arm), 0, kElbowDistance, proportions_.arm);
    add_target(at(Joint::left_upper_leg), across(Joint::left_upper_leg), 0.5, kHipsDistance * bent, proportions_.trunk,
               rests);
    return sum_ / std::max(1.0, weights_);
  }

 private:
  /// Adds the displacement that restores the position of the hand relative to a target: the point at `fraction` of the
  /// way from joint `a` to joint `b`. `distance`: see kHandsDistance. `ratio`: factor on the offset of the hand from
  /// the target, body / motion. `max_weight`: weight within `distance`.
  void add_target(std::size_t a, std::size_t b, double fraction, double distance, double ratio, double max_weight = 1) {
    if (!both_[a] || !both_[b] || !(distance > 0)) return;
    const auto place = [&](const Places& of) -> Vec3 { return (1 - fraction) * of[a] + fraction * of[b]; };
    const Vec3 offset = theirs_[hand_] - place(theirs_);
    const double weight = max_weight * (1 - ease(offset.norm() / (distance * proportions_.their_arm) - 1));
    sum_ += weight * (place(ours_) + ratio * offset - ours_[hand_]);
    weights_ += weight;
  }

  const Places &theirs_, &ours_;
  const std::array<bool, kJointCount>& both_;
  const Proportions& proportions_;
  std::size_t hand_ = 0;
  Vec3 sum_{0, 0, 0};
  double weights_ = 0;
};

}  // namespace

std::array<Vec3, 2> displace_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                                   const Proportions& proportions, const std::array<double, 2>& rests) {
  if (!(proportions.their_arm > 0)) return {Vec3::Zero(), Vec3::Zero()};
  HandDisplacement displacement(theirs, ours, both, proportions);
  return {displacement.compute(false, rests[0]), displacement.compute(true, rests[1])};
}

std::vector<std::array<double, 2>> find_resting_hands(std::span<const Posture> postures, std::span<const double> times,
                                                      double arm) {
  std::vector<std::array<double, 2>> rests(postures.size());
  for (const bool right : {false, true}) {
    // Offsets are in the axes of the hips, because resting hands move with the hips.
    std::vector<Vec3> offsets;
    for (const Posture& p : postures)
      offsets.push_back(p.rotations[0].conjugate() *
                        (p.places[joint_index(on_side(Joint::left_hand, right))] - p.places[joint_index(Joint::hips)]));
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      double furthest = 0;
      const auto extend_to = [&](std::size_t at) {
        furthest = std::max(furthest, (offsets[at] - offsets[k]).norm());
        return std::abs(times[at] - times[k]) < kRestTime;
      };
      for (std::size_t at = k; at > 0 && extend_to(at - 1);) --at;
      for (std::size_t at = k; at + 1 < offsets.size() && extend_to(at + 1);) ++at;
      rests[k][right] = 1 - ease(furthest / (kMaxRestMotion * arm) - 1);
    }
  }
  return rests;
}

}  // namespace weft::character
