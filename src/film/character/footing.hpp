// Foot contacts of a motion, and the poses of legs that keep feet in contact.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "film/character/anatomy.hpp"

namespace weft::character {

/// The keys from `first` to `last` (inclusive) at which the ball of a foot stays in place.
struct Contact {
  std::size_t first = 0, last = 0;
};

/// Contacts of both feet with the floor.
struct Footsteps {
  std::array<std::vector<Contact>, 2> contacts;  ///< of the left and the right foot, in chronological order
  std::vector<Flat> flat;                        ///< per posture: whether each foot is flat on the floor
  double ankle_height = 0;                       ///< height of the ankles of flat feet [m]
};

/// Finds the contacts of a motion from the speed and the height of the toe joints, or of the ankles if feet have no
/// toes. `times`: of the postures, increasing [s]. `up`: unit vector. If no leg has hip, knee and ankle joints, or if
/// no foot is ever in contact, `contacts` is empty, and ankle_height is the lowest height of any ankle (infinite
/// without feet).
Footsteps find_footsteps(const Skeleton& skeleton, std::span<const Posture> postures, std::span<const double> times,
                         const Vec3& up);

/// A leg at one key. solve_two_bone_ik() also accepts an arm: `hip`, `knee` and `ankle` are then its shoulder, elbow
/// and wrist.
struct Leg {
  Vec3 hip, knee, ankle;
  Vec3 ball, heel;  ///< points of the sole below the toe joint and below the ankle
  Vec3 hinge;       ///< unit vector of the axis about which the shin bends backward
};

/// The left and the right leg.
using Legs = std::array<Leg, 2>;

/// Corrections at one key. They keep feet that are in contact with the floor in place.
struct Stance {
  double rise = 0;                                          ///< upward displacement of the hips [m]
  std::array<Vec3, 2> shift{Vec3(0, 0, 0), Vec3(0, 0, 0)};  ///< displacement of each foot from the motion [m]
  std::array<bool, 2> in_contact{};
};

/// Computes, per key, the corrections that keep feet in place. During a contact, the ball of the foot stays at its mean
/// horizontal position over the contact, and the lower one of ball and heel is on the floor. The shift of the foot
/// fades within 0.15 s before and after the contact, or within the time to the next contact if this is shorter. Neither
/// ball nor heel goes below the floor. The hips move down if a leg is too short to reach its shifted ankle, and up if a
/// knee would bend too far. `legs`: of the body, per key. `floor`: height of the floor, on which the body stands in its
/// rest pose [m].
std::vector<Stance> plant_feet(std::span<const Legs> legs, const Footsteps& steps, std::span<const double> times,
                               double floor, const Vec3& up);

/// Rotations of the upper and the lower leg, in world axes, to be applied to the present pose.
struct LegTurns {
  Quat upper, lower;
};
/// Two-bone inverse kinematics: the rotations that move the ankle to the position `ankle`, or as near to it as the
/// limits of the knee allow. The knee bends in the present plane of the leg.
LegTurns solve_two_bone_ik(const Leg& leg, const Vec3& ankle);

}  // namespace weft::character
