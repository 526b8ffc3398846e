// Detects motions of four-legged animals. find_joints() (joints.hpp) takes their forelegs for arms, since names or
// places match.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// Returns a warning if a motion is on all fours: the trunk is at most 30° from horizontal on average, and the lower
/// hand is near the height of the lowest foot joint in at least half of the postures. `up`: unit vector.
std::optional<std::string> warn_if_on_all_fours(const Skeleton& skeleton, std::span<const Posture> postures,
                                                const Vec3& up);

}  // namespace weft::character
