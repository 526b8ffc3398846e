// Second derivatives on triangle meshes, as weighted sums of vertex positions.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The curvature vectors of one triangle as weighted sums of vertex positions x_k [1/m]: s_uu = Σ_k weights[k].x() x_k,
/// and s_vv and s_uv with y() and z().
struct CurvatureStencil {
  std::vector<Index> vertices;  ///< the triangle's own corners come first
  std::vector<Vec3> weights;    ///< for s_uu, s_vv and s_uv [1/m²]
};

/// Whether all corners of a triangle are marked. `marked`: per vertex; empty: none is marked.
inline bool all_corners_marked(const mesh::Triangle& triangle, std::span<const char> marked) {
  return !marked.empty() && std::ranges::all_of(triangle, [&](Index v) { return marked[at(v)] != 0; });
}

/// Returns one stencil per triangle. In a triangle of area A with edges of length l, unit tangents t and outward
/// in-plane normals n,
///
///     s_ab = 1/A Σ_edges l sym(n_a g_b),    g = n ∂s/∂n + t ∂s/∂t at the middle of the edge, a, b = u or v:
///
/// the plate element of Morley ("The Triangular Equilibrium Element in the Solution of Plate Bending Problems", 1968).
/// Morley's element has the slopes ∂s/∂n across the edges as unknowns. Here, the slope across an
/// edge is a weighted sum of the positions of nearby vertices, with weights for which the slope is
/// exact for quadratic functions (for linear ones, if too few vertices are near). Therefore s_ab is
/// exact for quadratic functions, too. Both triangles at an edge use the same slope; therefore a
/// constant moment exerts no force on vertices inside the sheet. Both properties are necessary for
/// the correct plate stiffness on any mesh (measured: the quadratic function through the vertices
/// of each triangle and its three neighbours has only the first property; with it, plates are 33 %
/// too soft on crossed meshes and 6 % on Delaunay meshes, at every resolution).
///
/// The slope across a border edge has the value of least energy, at which the moment about the border vanishes. As
/// Poisson's ratio is 0, the curvature across the border is then 0. An edge whose two triangles have the same three
/// corners counts as a border, because these corners do not define a slope.
///
/// A triangle with three held corners is a clamp: the slope across its edges is that of the
/// triangle's plane. The slope across other edges near a clamp is exact for linear functions, and
/// for the function that is 0 in the clamp and, in front of the clamp, the squared distance from
/// it. `held`: per vertex, whether it is held now. `pinned`: per vertex, whether it may ever be
/// held. `held` changes only the weights of a stencil, not its vertices, and only through the set of triangles with
/// three held corners. Empty `held`: no vertex is held. Empty `pinned`: no vertex may be held.
std::vector<CurvatureStencil> curvature_stencils(const mesh::Sheet& sheet, std::span<const char> pinned = {},
                                                 std::span<const char> held = {});

}  // namespace weft::forces
