// Detects motions of four-legged animals. find_joints() (joints.hpp) takes their forelegs for arms, because forelegs
// have the names of arms or the same place in the skeleton.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// Returns a warning if a motion is on all fours, else nullopt. A motion is on all fours if the mean absolute sine of
/// the angle between trunk and horizontal is at most 0.5 (30°), and if in at least half of the postures the lower hand
/// is less than 0.25 leg lengths above the lowest foot joint. `up`: unit vector.
std::optional<std::string> warn_if_on_all_fours(const Skeleton& skeleton, std::span<const Posture> postures,
                                                const Vec3& up);

}  // namespace weft::character
