// Where the panels of a garment start that are bent around parts of a wearer.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "garment/pattern.hpp"
#include "garment/start_shape.hpp"
#include "garment/triangulation.hpp"
#include "garment/wearer.hpp"

namespace weft::garment {

/// Whether two panels are drawn as seen from the same side of the cloth; then the edges of a seam between them run
/// against each other.
bool seen_alike(const Panel& a, const Panel& b);

/// For each panel, where each point of its flat mesh starts if nothing is sewn: at heights and lengths of its drawing
/// on the tube around its part, Pattern::gap and its layers away from the skin; where the panels of a ring are wider
/// than that, as far as closes the ring. A panel without a position goes along its part to where its seams to panels
/// that have a place are shortest. `refuse` gets what is wrong, and throws. In the wearer's axes [m].
std::vector<std::vector<Vec3>> bend_around(const Pattern& pattern, std::span<const FlatMesh> meshes,
                                           const Wearer& wearer, const std::function<void(const std::string&)>& refuse);

/// One place for each joined vertex, such that the edges keep the vectors they have in their panels as well as they can
/// (least squares); closing seams bends the panels over some 10 cm, `spacing` [m] being that of the mesh. `corners`:
/// of each triangle, where its panel alone puts them.
std::vector<Vec3> join_in_space(std::span<const mesh::Triangle> triangles, std::span<const std::array<Vec3, 3>> corners,
                                std::size_t vertices, double spacing);

/// Moves vertices that are nearer to the skin than `clearance` [m], or in it, out, those around them along.
void clear_of_skin(const Wearer& wearer, std::span<const mesh::Triangle> triangles, double clearance,
                   std::span<Vec3> x);

}  // namespace weft::garment
