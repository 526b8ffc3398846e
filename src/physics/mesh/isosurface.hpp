// Triangulates the zero set of a function, and makes its triangles even in size and shape.
#pragma once

#include <functional>

#include "physics/mesh/mesh.hpp"

namespace weft::mesh {

/// Implicit function [m], negative inside. The length of its gradient must stay below 3 everywhere. Near the zero set,
/// the gradient must be continuous and its length about 1 (as for a distance) or more.
using Field = std::function<double(const Vec3&)>;

/// Wanted edge length [m] at a point; it should vary slowly.
using Sizing = std::function<double(const Vec3&)>;

/// Marching tetrahedra on the half of `box` with x >= 0. Each cube of the lattice is cut into six tetrahedra along its
/// diagonal (Kuhn 1960); this leaves no ambiguous case, so the surface is always manifold. The surface is open at the
/// plane x = 0, where its border vertices have x = 0 exactly, and closed elsewhere if `box` contains all of it.
/// Features thinner than `cell` [m] may be missed.
Mesh march_half_space(const Field& field, const Box3& box, double cell);

/// Remeshes a surface toward the edge length `edge_length`: each round splits, collapses and flips edges, relaxes
/// vertices, and projects them back to the zero set (Botsch & Kobbelt, "A Remeshing Approach to Multiresolution
/// Modeling", 2004). Border vertices stay on the border and in its plane x = 0.
void remesh(Mesh& surface, const Field& field, const Sizing& edge_length, int rounds);

/// A surface whose border lies in x = 0, joined to its mirror image. Border vertices come first and are their own
/// images, then come the other vertices of the half; the image of such a vertex v is v + (number of these other
/// vertices).
struct MirroredMesh {
  Mesh mesh;
  std::vector<Index> image;  ///< index of the mirrored vertex, per vertex; itself on the plane
};
MirroredMesh join_mirror_image(const Mesh& half);

}  // namespace weft::mesh
