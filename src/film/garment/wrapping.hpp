// Start positions of the panels that are bent around parts of a wearer.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "film/garment/pattern.hpp"
#include "film/garment/start_shape.hpp"
#include "film/garment/triangulation.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// Whether two panels are drawn as seen from the same side of the cloth. If so, the two edges of a seam between them
/// run in opposite directions.
bool are_drawn_from_same_side(const Panel& a, const Panel& b);

/// For each panel, the start position of each point of its flat mesh before sewing. Points keep the heights and lengths
/// of the drawing on the tube around the panel's part. Their distance from the skin is Pattern::gap plus kLayerDistance
/// for each layer below. If panels that close around a part are wider than the girth there, they move outward until
/// they close; narrow sleeves move inward. A panel without a position moves along its part to where its seams to placed
/// panels are shortest. `refuse` receives a description of a mistake and must throw. Positions are in the wearer's axes
/// [m].
std::vector<std::vector<Vec3>> bend_around(const Pattern& pattern, std::span<const FlatMesh> meshes,
                                           const Wearer& wearer, const std::function<void(const std::string&)>& refuse);

/// One position for each joined vertex. The edges keep the vectors that they have in their panels as well as possible
/// (least squares); closing a seam bends the panels over about 10 cm. `corners`: per triangle, positions of its corners
/// in its panel alone; `spacing`: edge length of the mesh [m].
std::vector<Vec3> join_in_space(std::span<const mesh::Triangle> triangles, std::span<const std::array<Vec3, 3>> corners,
                                std::size_t vertices, double spacing);

/// Moves vertices that are inside the skin or nearer to it than `clearance` [m] outward, from depths of up to 8 cm;
/// vertices around them follow.
void move_out_of_skin(const Wearer& wearer, std::span<const mesh::Triangle> triangles, double clearance,
                      std::span<Vec3> x);

}  // namespace weft::garment
