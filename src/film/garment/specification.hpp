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
/// determine the body part of each panel. Heights, angles and rotations are those of the specification, with these
/// exceptions:
/// - Seams determine the positions of panels around arms and neck.
/// - Panels of limbs start at the front or the back unless they face sideways. Their lower ends are centred on the axis
///   of the limb, and their rotations are multiples of 90 degrees.
/// - Panels that are folded over, such as lapels, start on top of the panels to which they are sewn.
/// - If a GarmentCode pattern would start lower than kMinStartHeight (specification.cpp) above the floor, it is raised.
/// The names of edges are their numbers in the specification, from 0. If there are mistakes, reports them to `findings`
/// and returns false. Does not check outlines and edge names; read_pattern() (pattern.hpp) does.
bool read_specification(const std::string& text, scene::Findings& findings, Pattern& pattern);

}  // namespace weft::garment
