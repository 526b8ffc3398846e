// Reads patterns of GarmentCode and of its predecessor, the Garment-Pattern-Generator (Korosteleva & Lee, "Generating
// Datasets of 3D Garments with Sewing Patterns", 2021; Korosteleva & Sorkine-Hornung, "GarmentCode: Programming
// Parametric Sewing Patterns", 2023). Their files (specifications) contain flat panels, placed around a body that faces
// +z with y up, and stitches between panel edges.
#pragma once

#include <string>

#include "film/garment/pattern.hpp"
#include "film/scene/findings.hpp"

namespace weft::garment {

/// Converts a specification (JSON) to a pattern whose panels start bent around the wearer. Labels, names and stitches
/// determine the part of the body for each panel. Heights, angles and rotations come from the specification, with two
/// exceptions: seams determine the heights of panels around arms and neck, and panels of limbs start at the front or
/// the back unless they face sideways. Edges are named by their numbers. If there are mistakes, reports them to
/// `findings` and returns false. Leaves the check of outlines and edge names to read_pattern() (pattern.hpp).
bool read_specification(const std::string& text, scene::Findings& findings, Pattern& pattern);

}  // namespace weft::garment
