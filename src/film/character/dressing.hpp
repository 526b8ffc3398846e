// Prepares a body for clothes that were not made for it: poses its arms, and shrinks it toward its bones at the start.
#pragma once

#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Returns the pose with straight arms in the frontal plane of the body. `degrees`: angle of both arms from straight
/// down; at 90 they point straight to the sides. If the rig has no pair of arms, the pose does not change. `up`: unit
/// vector.
Pose raise_arms(const Rig& rig, const Pose& pose, double degrees, const Vec3& up);

/// For each vertex, the point inside the body from which the vertex grows: the mean of the nearest points on the bones
/// that influence the vertex, weighted by the influences. A bone that branches has one nearest point per branch,
/// weighted by the inverse fourth power of the distance from the vertex. A vertex that two limbs influence equally, as
/// between the legs, grows from the mean position of the joints of its bones.
std::vector<Vec3> growth_start_positions(const Character& character, const Pose& pose);

/// Distance of the skin of a growing body from its bones, as a fraction of the final distance. `t`: time since the
/// start of growth; `duration`: of growth [s]. The fraction rises smoothly from 0.1, at which an arm fits into a sleeve
/// with clearance, to 1.
double grown(double t, double duration);

}  // namespace weft::character
