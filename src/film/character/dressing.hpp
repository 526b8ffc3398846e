// Prepares a body for clothes that were not made for it: poses its arms, and shrinks it toward its bones at the start.
#pragma once

#include <vector>

#include "film/character/anatomy.hpp"
#include "film/character/pose.hpp"

namespace weft::character {

/// Returns the pose with straight arms in the frontal plane of the body. `degrees`: angle of both arms from straight
/// down; 90: straight to the sides. Returns `pose` unchanged if the rig has neither two upper-arm joints nor two
/// shoulder joints, or if the line through them is vertical. `up`: unit vector.
Pose raise_arms(const Rig& rig, const Pose& pose, double degrees, const Vec3& up);

/// For each vertex, the point on the bones from which the vertex grows [m]. It is the mean, weighted by the influences,
/// of one point per bone that influences the vertex:
/// - The point on a bone is the one nearest to the vertex. If the bone branches, it is the mean of the nearest points
///   of all branches, weighted by the inverse fourth power of their distance from the vertex.
/// - If bones of other branches, such as the other leg, also influence the vertex, the point is moved toward the joint
///   of its bone. It is at the joint if these other bones have at least half of the weight.
std::vector<Vec3> growth_start_positions(const Character& character, const Pose& pose);

/// Distance of the skin of a growing body from its bones, as a fraction of the final distance. `t`: time since the
/// start of growth [s]; `duration`: of the growth, > 0 [s]. The fraction increases smoothly from 0.1, at which an arm
/// fits into a sleeve with clearance, to 1 at `duration`.
double growth_fraction(double t, double duration);

}  // namespace weft::character
