// Places where surfaces touch or cross at the start of a run, for error messages and pictures.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "physics/collision/bodies.hpp"
#include "physics/collision/response/separating_plane.hpp"
#include "physics/simulation/simulation.hpp"

namespace weft::simulation {

/// Groups pairs of triangles that touch or cross into places; the place with most pairs comes first. Pairs of the same
/// two objects belong to one place if their triangles share vertices, directly or through other pairs. `x`: all
/// vertices [m]; `names`: of all cloths and bodies.
std::vector<IntersectionPlace> group_intersections(std::span<const collision::CornerPair> pairs,
                                                   const collision::Bodies& bodies, std::span<const std::string> names,
                                                   std::span<const Vec3> x);

}  // namespace weft::simulation
