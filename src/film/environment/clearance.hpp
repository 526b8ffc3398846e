// Finds where the skin of a character must leave space for cloth: above the ground, and between limbs near cloth.
#pragma once

#include <span>
#include <vector>

#include "film/character/limb_clearance.hpp"
#include "film/environment/actor.hpp"
#include "film/environment/character_context.hpp"

namespace weft::environment {

/// The grounds on which a body can lie: infinite planes that collide and do not move, in the coordinates of the body.
std::vector<character::Ground> static_grounds(const CharacterContext& context);

/// Height of the lowest of the points `x` over the ground [m].
double height_over(const character::Ground& ground, std::span<const Vec3> x);

/// Clearance between limbs [m]: the key `room` of the character. If the scene does not set it: kLayersBetweenLimbs
/// (clearance.cpp) times the largest contact thickness of the cloths; but 0 for characters that do not collide, and for
/// the mannequin without a motion file, because its own walk keeps the arms away from the body.
double clearance_between_limbs(const CharacterContext& context);

/// Nearness of cloth to each point of the skin: 1 up to a distance of 2.5 cm, then decreasing linearly to 0 at 5 cm.
/// `skin`: positions in the world [m].
std::vector<float> nearness_of_cloth(std::span<const Vec3> skin, const ClothAtStart& cloth);

/// Nearness of cloth to each vertex of a body: the maximum over all cloths of nearness_of_cloth() at the time when the
/// cloth is put on. `performance`: motion of the body.
std::vector<float> nearness_of_cloths(const CharacterContext& context, const character::Character& body,
                                      const character::Performance& performance, std::span<const ClothAtStart> cloths);

}  // namespace weft::environment
