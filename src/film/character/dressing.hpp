// Prepares a body for clothes that were not made for it: poses its arms and makes it thin at the start.
#pragma once

#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// A pose with straight arms in the frontal plane of the body. `degrees`: angle of both arms from hanging; 90 is
/// straight out to the sides. A rig without a pair of arms keeps the pose. `up`: unit vector.
Pose raise_arms(const Rig& rig, const Pose& pose, double degrees, const Vec3& up);

/// Start position inside the body from which each vertex grows: the nearest points on the bones that influence it,
/// averaged by the influence weights and, where bones branch, by the inverse fourth power of the distance. Vertices
/// that two limbs influence equally, as between the legs, grow from the mean position of the joints of these bones.
std::vector<Vec3> growth_start_positions(const Character& character, const Pose& pose);

/// Fraction of the distance from bone to skin that a body has reached at time `t` [s] after the start of growth, which
/// takes `duration` [s]. Rises smoothly from 0.1, at which a sleeve has clearance, to 1.
double grown(double t, double duration);

}  // namespace weft::character
