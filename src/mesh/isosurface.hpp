// Triangles on the zero set of a function, even in size and shape.
#pragma once

#include <functional>

#include "mesh/mesh.hpp"

namespace weft::mesh {

/// Negative inside; at least about as steep as a distance [m] and continuously differentiable near its zero set. Its
/// slope must stay below 3.
using Field = std::function<double(const Vec3&)>;

/// A length [m] for each place; should change slowly.
using Sizing = std::function<double(const Vec3&)>;

/// Marching tetrahedra on the part of `box` where x >= 0: a cube of the lattice is cut into six tetrahedra along its
/// diagonal (Kuhn 1960), which leaves no ambiguous case, so the surface is always manifold. It is open where it meets
/// the plane x = 0, its border vertices having x = 0 exactly, and closed elsewhere if `box` holds all of it. Parts
/// thinner than `cell` [m] may be missed.
Mesh march_half_space(const Field& field, const Box3& box, double cell);

/// Remeshes a surface to edges of the length `edge_length`: splits, collapses, flips and relaxes in turn, and draws
/// the vertices back to the zero set (Botsch & Kobbelt, "A Remeshing Approach to Multiresolution Modeling", 2004).
/// Border vertices stay on the border and in its plane x = 0.
void remesh(Mesh& surface, const Field& field, const Sizing& edge_length, int rounds);

/// Joins a surface whose border lies in x = 0 to its mirror image: vertex v has its image at v + (number of vertices
/// off the border), border vertices come first and have none.
struct MirroredMesh {
  Mesh mesh;
  std::vector<Index> image;  ///< per vertex, that on the other side; itself on the plane
};
MirroredMesh join_mirror_image(const Mesh& half);

}  // namespace weft::mesh
