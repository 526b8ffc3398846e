// Triangulates the zero set of a function, with triangles of even size and shape.
#pragma once

#include <functional>

#include "physics/mesh/mesh.hpp"

namespace weft::mesh {

/// Implicit function [m], negative inside. The length of its gradient must be below 3 everywhere. Near the zero set,
/// the gradient must be continuous, with a length of about 1 (as for a distance) or more.
using Field = std::function<double(const Vec3&)>;

/// Wanted edge length [m] at a point. It should vary slowly from point to point.
using Sizing = std::function<double(const Vec3&)>;

/// Triangulates the zero set in the half of `box` with x >= 0 by marching tetrahedra. The search
/// region may extend beyond the upper sides of `box` by up to four cells. Each cube of the lattice
/// is cut into six tetrahedra along its diagonal (Kuhn 1960). No case is ambiguous, so the surface
/// is always manifold. The surface is open at the plane x = 0, where its border vertices have x = 0
/// exactly; elsewhere it is closed if `box` contains all of it. `cell`: edge length of a cube [m];
/// features thinner than a cube may be missed.
Mesh march_half_space(const Field& field, const Box3& box, double cell);

/// Remeshes a surface toward the edge length `edge_length`. Each round splits, collapses and flips edges, then moves
/// each vertex toward the mean of its neighbours and projects it back to the zero set (Botsch &
/// Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004). Vertices on the border move
/// only along the border, in its plane x = 0.
void remesh(Mesh& surface, const Field& field, const Sizing& edge_length, int rounds);

/// A surface whose border lies in the plane x = 0, joined to its mirror image in this plane. Order
/// of vertices: first those of the border, which are their own images; then the n other vertices of
/// `half`; then their n images in the same order. Thus the image of a vertex v of the second group
/// is v + n.
struct MirroredMesh {
  Mesh mesh;
  std::vector<Index> image;  ///< per vertex, the index of its mirror image
};
MirroredMesh join_mirror_image(const Mesh& half);

}  // namespace weft::mesh
