// Second derivatives on triangle meshes, as weighted sums of vertices.
#pragma once

#include <span>
#include <vector>

#include "mesh/sheet.hpp"

namespace weft::forces {

/// The curvature vectors s_uu, s_vv and s_uv of one triangle [1/m]: Σ_k weights[k] x_k, one component of the weights
/// for each.
struct CurvatureStencil {
  std::vector<Index> vertices;  ///< the triangle's own corners come first
  std::vector<Vec3> weights;    ///< of s_uu, s_vv and s_uv [1/m²]
};

/// One stencil per triangle. In a triangle of area A with edges of length l and outward normals n,
///
///     s_ab = 1/A Σ_edges l sym(n_a g_b),    g = n ∂s/∂n + t ∂s/∂t at the middle of the edge:
///
/// the plate element of Morley ("The Triangular Equilibrium Element in the Solution of Plate Bending Problems", 1968),
/// whose unknown slopes ∂s/∂n across the edges are here weighted sums of the vertices around the edge, exact for
/// quadratic functions. So s_ab is exact for them too; and because both triangles at an edge take the same slope, a
/// constant moment leaves no force on inner vertices. Both are needed for the stiffness to be that of the plate on any
/// mesh: a quadratic through each triangle and its three neighbours has the first and not the second, and is 33 % too
/// soft on crossed meshes and 6 % on Delaunay meshes at every resolution (measured; see the tests).
///
/// Across the border the slope is free: it takes the value of least energy, for which the moment about the border
/// vanishes (κ_nn = 0, ν = 0).
///
/// A triangle with three held corners is a clamp: at its edges the slope is its own, and a slope that is made of
/// vertices on both sides of such an edge is exact for functions linear in the clamp and as s² in front of it, s the
/// distance from it. `held`: by vertex, now; `pinned`: at any time, so that stencils have the same vertices at all.
/// Empty: none.
std::vector<CurvatureStencil> curvature_stencils(const mesh::Sheet& sheet, std::span<const char> pinned = {},
                                                 std::span<const char> held = {});

}  // namespace weft::forces
