// Puts bodies that play the motion of another file on the floor.
#pragma once

#include "film/environment/character_context.hpp"

namespace weft::environment {

/// How far a body that plays a motion of another file is moved so that it walks on the floor, in its own coordinates
/// [m]. If its soles are 5 cm or more above or below the origin of its file, they are put at the height of the origin;
/// else zero.
Vec3 floor_offset(const CharacterContext& context, const character::Character& body);

/// Moves the body by floor_offset(), and warns if it does.
void put_on_floor(const CharacterContext& context, Body& body);

}  // namespace weft::environment
