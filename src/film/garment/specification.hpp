// Patterns of GarmentCode and of its predecessor, the Garment-Pattern-Generator (Korosteleva & Lee, "Generating
// Datasets of 3D Garments with Sewing Patterns", 2021; Korosteleva & Sorkine-Hornung, "GarmentCode: Programming
// Parametric Sewing Patterns", 2023): flat panels, placed around a body that faces z with y up, and stitches between
// their edges.
#pragma once

#include <string>

#include "film/garment/pattern.hpp"
#include "film/scene/findings.hpp"

namespace weft::garment {

/// Reads a specification (JSON) as a pattern whose panels are bent around the wearer. Heights, angles and rotations are
/// those of the specification, except that seams determine the heights of panels around arms and neck, and that panels
/// of limbs go to the front or the back unless they face sideways. Labels, names and stitches determine the part that
/// each panel goes around. Edges are named by their numbers. Reports mistakes to `findings` and then returns false.
/// Does not check outlines and edge names.
bool read_specification(const std::string& text, scene::Findings& findings, Pattern& pattern);

}  // namespace weft::garment
