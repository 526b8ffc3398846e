#include "character/four_legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::character {
namespace {

/// A trunk on all fours is less steep in the mean [1]: 30 degrees.
constexpr double kLevelTrunk = 0.5;

/// Hands on the floor are no higher over the lowest foot, by the length of a leg.
constexpr double kHandsOnFloor = 0.25;

double lowest(const Skeleton& skeleton, const Posture& posture, std::initializer_list<Joint> joints, const Vec3& up) {
  double height = std::numeric_limits<double>::infinity();
  for (const Joint joint : joints)
    if (skeleton.has(joint)) height = std::min(height, up.dot(posture.places[place_of(joint)]));
  return height;
}

}  // namespace

std::optional<std::string> doubt_of_two_legs(const Skeleton& skeleton, std::span<const Posture> postures,
                                             const Vec3& up) {
  if (postures.empty()) return std::nullopt;
  const double leg = skeleton.leg_length(postures.front());
  double steepness = 0, on_floor = 0;
  for (const Posture& posture : postures) {
    steepness += std::abs(up.dot(skeleton.trunk(posture).normalized()));
    const double feet =
        lowest(skeleton, posture, {Joint::left_foot, Joint::left_toes, Joint::right_foot, Joint::right_toes}, up);
    const double hands = lowest(skeleton, posture, {Joint::left_hand, Joint::right_hand}, up);
    on_floor += hands - feet < kHandsOnFloor * leg ? 1 : 0;
  }
  const auto count = static_cast<double>(postures.size());
  if (steepness > kLevelTrunk * count || 2 * on_floor < count) return std::nullopt;
  return fmt::format(
      "it goes on all fours in {:.0f} % of its time, as animals with four legs do, whose motions do not fit a body on "
      "two legs",
      100 * on_floor / count);
}

}  // namespace weft::character
