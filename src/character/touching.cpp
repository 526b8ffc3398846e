#include "character/touching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::character {
namespace {

// Distances of the wrist, in lengths of the arm (0.55 m in an adult), up to which a hand is taken to touch; from twice
// these on it does not. Of hands that are together wrists are 5 to 12 cm apart, so half of that from their middle; a
// hand that holds an elbow has its wrist 8 to 13 cm from the joint, one on a hip 17 to 22 cm from between the hips.
constexpr double kHandsReach = 0.12, kElbowReach = 0.2, kHipsReach = 0.4;
// Arms that are bent by less hang [radians], and by more reach for something.
constexpr double kHanging = 40 * std::numbers::pi / 180, kReaching = 70 * std::numbers::pi / 180;

// A hand that goes less far than this against the hips, in lengths of the arm, within the time [s] rests: 5 cm in 0.2
// s. Hands of those who walk and run go 20 to 60 cm.
constexpr double kStays = 0.09, kMoment = 0.1;

class Puller {
 public:
  Puller(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
         const Proportions& proportions)
      : theirs_(theirs), ours_(ours), both_(both), proportions_(proportions) {}

  Vec3 pull(bool right, double rests) {
    const auto at = [&](Joint left) { return place_of(on_side(left, right)); };
    const auto across = [&](Joint left) { return place_of(on_side(left, !right)); };
    const std::size_t shoulder = at(Joint::left_upper_arm), elbow = at(Joint::left_lower_arm);
    hand_ = at(Joint::left_hand);
    if (!both_[shoulder] || !both_[elbow] || !both_[hand_]) return Vec3::Zero();
    sum_.setZero();
    weights_ = 0;
    const Vec3 upper = theirs_[elbow] - theirs_[shoulder], lower = theirs_[hand_] - theirs_[elbow];
    const double bend = std::atan2(upper.cross(lower).norm(), upper.dot(lower));
    const double bent = ease((bend - kHanging) / (kReaching - kHanging));
    between(hand_, across(Joint::left_hand), 0.5, kHandsReach, proportions_.arm);
    between(across(Joint::left_lower_arm), across(Joint::left_lower_arm), 0, kElbowReach, proportions_.arm);
    between(at(Joint::left_upper_leg), across(Joint::left_upper_leg), 0.5, kHipsReach * bent, proportions_.trunk,
            rests);
    return sum_ / std::max(1.0, weights_);
  }

 private:
  /// Something that lies a `share` of the way from joint `a` to `b`.
  void between(std::size_t a, std::size_t b, double share, double near, double ratio, double most = 1) {
    if (!both_[a] || !both_[b] || !(near > 0)) return;
    const auto place = [&](const Places& of) -> Vec3 { return (1 - share) * of[a] + share * of[b]; };
    const Vec3 way = theirs_[hand_] - place(theirs_);
    const double weight = most * (1 - ease(way.norm() / (near * proportions_.their_arm) - 1));
    sum_ += weight * (place(ours_) + ratio * way - ours_[hand_]);
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

std::array<Vec3, 2> pull_hands(const Places& theirs, const Places& ours, const std::array<bool, kJointCount>& both,
                               const Proportions& proportions, const std::array<double, 2>& rests) {
  if (!(proportions.their_arm > 0)) return {Vec3::Zero(), Vec3::Zero()};
  Puller puller(theirs, ours, both, proportions);
  return {puller.pull(false, rests[0]), puller.pull(true, rests[1])};
}

std::vector<std::array<double, 2>> find_rests(std::span<const Posture> postures, std::span<const double> times,
                                              double arm) {
  std::vector<std::array<double, 2>> rests(postures.size());
  for (const bool right : {false, true}) {
    // In the axes of the hips, with which hands that rest on them go.
    std::vector<Vec3> ways;
    for (const Posture& p : postures)
      ways.push_back(p.rotations[0].conjugate() *
                     (p.places[place_of(on_side(Joint::left_hand, right))] - p.places[place_of(Joint::hips)]));
    for (std::size_t k = 0; k < ways.size(); ++k) {
      double furthest = 0;
      const auto look = [&](std::size_t at) {
        furthest = std::max(furthest, (ways[at] - ways[k]).norm());
        return std::abs(times[at] - times[k]) < kMoment;
      };
      for (std::size_t at = k; at > 0 && look(at - 1);) --at;
      for (std::size_t at = k; at + 1 < ways.size() && look(at + 1);) ++at;
      rests[k][right] = 1 - ease(furthest / (kStays * arm) - 1);
    }
  }
  return rests;
}

}  // namespace weft::character
