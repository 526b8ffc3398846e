// Colours painted on the mannequin so that it looks like a person: hair, ears, brows, eyes, lips, cheeks and shoes.
#pragma once

#include "film/character/character.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {

/// Makes the colours for the mesh of a mannequin at rest, z up. Pictures are projected along an axis, so that their
/// outlines are equally sharp on coarse and fine triangles. The mesh does not change.
Coloring paint_figure(const mesh::Mesh& mesh, const MannequinBuild& build);

}  // namespace weft::character
