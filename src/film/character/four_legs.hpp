// Detects motions of four-legged animals, whose forelegs have the names or places of arms.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// Warning text for a motion on all fours: the trunk slopes by at most 30° on average, and a hand is near the floor for
/// at least half of the time. None for other motions. `up`: unit vector.
std::optional<std::string> warn_if_on_all_fours(const Skeleton& skeleton, std::span<const Posture> postures,
                                                const Vec3& up);

}  // namespace weft::character
