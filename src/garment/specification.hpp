// Patterns of GarmentCode and of its forerunner, the Garment-Pattern-Generator (Korosteleva & Lee, "Generating Datasets
// of 3D Garments with Sewing Patterns", 2021; Korosteleva & Sorkine-Hornung, "GarmentCode: Programming Parametric
// Sewing Patterns", 2023): flat panels, placed around a body that faces z with y up, and stitches between their edges.
#pragma once

#include <string>

#include "garment/pattern.hpp"
#include "scene/findings.hpp"

namespace weft::garment {

/// A specification (JSON) as a pattern whose panels are bent around the wearer: heights, angles and turns are those of
/// its panels, what each goes around follows from labels, names and stitches. Edges are named by their numbers. What is
/// wrong goes to the findings, and false comes back; outlines and names of edges are left to be checked.
bool read_specification(const std::string& text, scene::Findings& findings, Pattern& pattern);

}  // namespace weft::garment
