// Colours painted on the mannequin so that it looks like a person: hair, ears, brows, eyes, lips, cheeks and shoes.
#pragma once

#include "film/character/character.hpp"
#include "film/character/mannequin.hpp"

namespace weft::character {

/// Makes the colours for the mesh of a mannequin in the rest pose, z up, as pictures that are projected along the x or
/// y axis. Pictures have sharp outlines even on coarse triangles; colours of vertices would not.
Coloring paint_figure(const mesh::Mesh& mesh, const MannequinBuild& build);

}  // namespace weft::character
