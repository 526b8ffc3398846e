// How a body stands to be put into clothes that were not made for it: its arms as those of the clothes, and thin.
#pragma once

#include <vector>

#include "character/anatomy.hpp"
#include "character/pose.hpp"

namespace weft::character {

/// A pose with straight arms in the plane across the body. `degrees`: of both arms from hanging down, 90 straight out
/// to the sides. A rig without arms, or without a left and a right, keeps the pose. `up`: unit vector.
Pose raise_arms(const Rig& rig, const Pose& pose, double degrees, const Vec3& up);

/// Of each vertex the place inside of the body from which it grows: where it is nearest on the bones that hold it, in
/// the means by their weights and, where bones part, by the inverse fourth powers of its distances. What two limbs hold
/// alike, as between the legs, grows from where they part.
std::vector<Vec3> places_on_bones(const Character& character, const Pose& pose);

/// Share of the way from its bones to its skin that a body has grown a time `t` [s] after it began, of `duration` [s]:
/// from a tenth, which leaves room in a sleeve, to 1, without a jerk at either end.
double grown(double t, double duration);

}  // namespace weft::character
