// Start positions of panels that are bent around parts of a wearer.
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

/// Whether two panels are drawn from the same side of the cloth. If so, their edges in a seam run in opposite
/// directions.
bool are_drawn_from_same_side(const Panel& a, const Panel& b);

/// For each panel, the start positions [m] of the points of its flat mesh, before sewing, in the axes of the wearer.
/// - On the tube of the panel's part, each point has the height and the length across that it has in the drawing. Its
///   distance from the skin is Pattern::gap plus kLayerDistance for each layer below.
/// - The panels around a part form a ring. If the ring is wider than the girth at a height, its panels move outward
///   until the ring closes. Panels of narrow sleeves start nearer to the skin than Pattern::gap.
/// - If the pattern states no position for a panel, the panel gets the position along its part at which its seams to
///   panels with known positions are shortest. Around torso and body, this includes the position across, if all these
///   panels are around the same part.
/// `refuse` receives the description of a mistake and must throw.
std::vector<std::vector<Vec3>> bend_around(const Pattern& pattern, std::span<const FlatMesh> meshes,
                                           const Wearer& wearer, const std::function<void(const std::string&)>& refuse);

/// One position for each vertex of the garment. Edges of the mesh keep the vectors that they have in their panels as
/// well as possible (least squares); closing a seam bends its panels over about 10 cm times `size`, the size_factor()
/// of the wearer. `corners`: per triangle, the positions of its corners before sewing; `spacing`: edge length of the
/// mesh [m].
std::vector<Vec3> join_in_space(std::span<const mesh::Triangle> triangles, std::span<const std::array<Vec3, 3>> corners,
                                std::size_t vertices, double spacing, double size);

/// Moves vertices that are inside the skin, or less than `clearance` [m] outside it, outward to this distance. Vertices
/// more than 8 cm, times size_factor(), from all vertices of the skin do not move. Smooths moved vertices and those
/// around them.
void move_out_of_skin(const Wearer& wearer, std::span<const mesh::Triangle> triangles, double clearance,
                      std::span<Vec3> x);

}  // namespace weft::garment
