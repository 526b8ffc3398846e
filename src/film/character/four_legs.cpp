#include "film/character/four_legs.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace weft::character {
namespace {

/// A motion is on all fours only if the mean absolute sine of the angle between trunk and horizontal is at most this. A
/// sine of 0.5 is an angle of 30°.
constexpr double kMaxTrunkSlope = 0.5;

/// A hand is on the floor if it is less than this above the lowest foot [leg lengths].
constexpr double kMaxHandHeight = 0.25;

}  // namespace

std::optional<std::string> warn_if_on_all_fours(const Skeleton& skeleton, std::span<const Posture> postures,
                                                const Vec3& up) {
  if (postures.empty()) return std::nullopt;
  const double leg = skeleton.leg_length(postures.front());
  double steepness = 0, on_floor = 0;
  for (const Posture& posture : postures) {
    steepness += std::abs(up.dot(skeleton.trunk(posture).normalized()));
    const double feet = skeleton.lowest_height(posture, kFootJoints, up),
                 hands = skeleton.lowest_height(posture, std::array{Joint::left_hand, Joint::right_hand}, up);
    on_floor += hands - feet < kMaxHandHeight * leg ? 1 : 0;
  }
  const auto count = static_cast<double>(postures.size());
  if (steepness > kMaxTrunkSlope * count || 2 * on_floor < count) return std::nullopt;
  return fmt::format(
      "it goes on all fours in {:.0f} % of its time, as animals with four legs do, whose motions do not fit a body on "
      "two legs",
      100 * on_floor / count);
}

}  // namespace weft::character
