// Feet that stand: where a motion has its feet on the floor, and the legs that keep them there.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "character/anatomy.hpp"

namespace weft::character {

/// Keys from `first` to `last` in which the ball of a foot stays where it is.
struct Contact {
  std::size_t first = 0, last = 0;
};

struct Footsteps {
  std::array<std::vector<Contact>, 2> contacts;  ///< of the left and the right foot, in order
  std::vector<Flat> flat;                        ///< per posture
  double ankle_height = 0;                       ///< of feet that are flat on the floor [m]
};

/// Finds the steps of a motion from how slow and how low the toes are, or the ankles of feet without. `times`: of the
/// postures, increasing [s]. `up`: unit vector. Without feet or steps there are no contacts, and the lowest ankle is
/// taken to stand.
Footsteps find_footsteps(const Skeleton& skeleton, std::span<const Posture> postures, std::span<const double> times,
                         const Vec3& up);

/// A leg at a key; to reach() also an arm, with shoulder, elbow, wrist and hinge.
struct Leg {
  Vec3 hip, knee, ankle;
  Vec3 ball, heel;  ///< of the sole, below the toe joint and below the ankle
  Vec3 hinge;       ///< unit vector about which the shin turns backward
};

/// Legs of the left and the right side.
using Legs = std::array<Leg, 2>;

/// What makes feet stand, at one key.
struct Stance {
  double rise = 0;                                          ///< of the hips [m]
  std::array<Vec3, 2> shift{Vec3(0, 0, 0), Vec3(0, 0, 0)};  ///< of the feet, against where they were [m]
  std::array<bool, 2> in_contact{};
};

/// Keeps the ball of each foot at its mean place over a contact, the sole on the floor there and nowhere below it;
/// between contacts feet come back to the motion within 0.15 s. Hips come down where a leg would not reach, and up
/// where a knee would fold too far. `floor`: height of the sole at rest [m].
std::vector<Stance> plant_feet(std::span<const Legs> legs, const Footsteps& steps, std::span<const double> times,
                               double floor, const Vec3& up);

/// Turns of upper and lower leg in the world that bring the ankle to a place, or as near as the leg reaches, with the
/// knee in the plane that it was in.
struct LegTurns {
  Quat upper, lower;
};
LegTurns reach(const Leg& leg, const Vec3& ankle);

}  // namespace weft::character
