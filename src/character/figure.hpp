// What is painted on the mannequin, so that it reads as a person: hair, brows, lids and lips, fingers, shoes.
#pragma once

#include "character/character.hpp"
#include "character/mannequin.hpp"

namespace weft::character {

/// On the mesh of a mannequin at rest, z up. Pictures are laid on by looking along an axis, so that their outlines are
/// as sharp on coarse triangles as on fine ones, and what cloth meets stays as it is.
Coloring figure_of(const mesh::Mesh& mesh, const MannequinBuild& build);

}  // namespace weft::character
