// Where the skin of a character has to leave cloth room: what it lies on, and which of it is near cloth.
#pragma once

#include <span>
#include <vector>

#include "character/room.hpp"
#include "environment/acting.hpp"
#include "environment/cast.hpp"

namespace weft::environment {

/// What a body can lie on: planes without end that stand still, as the body has them.
std::vector<character::Ground> grounds_below(const Cast& cast);

/// Of the lowest of some vertices [m].
double height_over(const character::Ground& ground, std::span<const Vec3> x);

/// What the scene says, else what its cloths need [m]. The walk of the mannequin keeps its arms off by itself.
double room_between_limbs(const Cast& cast);

/// How near cloth lies to each of some places: 1 up to half of 5 cm, then less, 0 from 5 cm on. Of bodies whose
/// vertices are skin, in the world [m].
std::vector<float> nearness_of_cloth(std::span<const Vec3> skin, const ClothAtStart& cloth);

/// How near any cloth of the scene lies to each vertex when it is put on. `performance`: of the body, which has so many
/// `vertices`.
std::vector<float> nearness_of_cloths(const Cast& cast, const character::Character& body,
                                      const character::Performance& performance, std::span<const ClothAtStart> cloths);

}  // namespace weft::environment
