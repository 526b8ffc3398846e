// Finds where a character must leave space for cloth: above the ground, between its limbs, and where its skin is near
// cloth.
#pragma once

#include <span>
#include <vector>

#include "film/character/room.hpp"
#include "film/environment/acting.hpp"
#include "film/environment/cast.hpp"

namespace weft::environment {

/// The grounds on which a body can lie: infinite planes that collide and stand still, in the body's coordinates.
std::vector<character::Ground> static_grounds(const Cast& cast);

/// Height of the lowest of these points over the ground [m].
double height_over(const character::Ground& ground, std::span<const Vec3> x);

/// Clearance between limbs [m]: as the scene sets it, else as its thickest cloth needs. If the scene does not set it,
/// it is 0 for characters that do not collide, and for the mannequin without a motion file, whose walk keeps its arms
/// off its body.
double clearance_between_limbs(const Cast& cast);

/// Nearness of cloth to each point of the skin: 1 up to a distance of 2.5 cm, then falling linearly to 0 at 5 cm.
/// `skin`: points in the world [m].
std::vector<float> nearness_of_cloth(std::span<const Vec3> skin, const ClothAtStart& cloth);

/// Largest nearness of any cloth to each vertex when that cloth is put on. `performance`: motion of the body.
std::vector<float> nearness_of_cloths(const Cast& cast, const character::Character& body,
                                      const character::Performance& performance, std::span<const ClothAtStart> cloths);

}  // namespace weft::environment
