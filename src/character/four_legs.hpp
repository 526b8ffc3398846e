// Motions of animals with four legs, whose forelegs are taken for arms.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "character/anatomy.hpp"

namespace weft::character {

/// What to say of a motion that goes on all fours, for half of its time or more; none of others. `up`: unit vector.
std::optional<std::string> doubt_of_two_legs(const Skeleton& skeleton, std::span<const Posture> postures,
                                             const Vec3& up);

}  // namespace weft::character
