// Detects motions of four-legged animals, whose forelegs have the names or places of arms.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// Warning text for a motion that is on all fours for at least half of its time; empty for others. `up`: unit vector.
std::optional<std::string> warn_if_on_all_fours(const Skeleton& skeleton, std::span<const Posture> postures,
                                                const Vec3& up);

}  // namespace weft::character
