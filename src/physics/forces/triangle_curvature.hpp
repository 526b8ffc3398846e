// Second derivatives on triangle meshes, as weighted sums of vertex positions.
#pragma once

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

/// Returns one stencil per triangle. In a triangle of area A with edges of length l, unit tangents t and outward
/// in-plane normals n,
///
///     s_ab = 1/A Σ_edges l sym(n_a g_b),    g = n ∂s/∂n + t ∂s/∂t at the middle of the edge, a, b = u or v:
///
/// the plate element of Morley ("The Triangular Equilibrium Element in the Solution of Plate Bending Problems", 1968).
/// Morley's element has the slopes ∂s/∂n across the edges as unknowns. Here, the slope across an edge is a weighted sum
/// of the positions of nearby vertices, with weights for which it is exact for quadratic functions. Therefore s_ab is
/// exact for quadratic functions, too. Both triangles at an edge use the same slope; therefore a constant moment exerts
/// no force on inner vertices. Both properties are necessary for the correct plate stiffness on any mesh (measured: a
/// quadratic through each triangle and its three neighbours has only the first property; it is 33 % too soft on crossed
/// meshes and 6 % on Delaunay meshes, at every resolution).
///
/// The slope across a border edge has the value of least energy, at which the moment about the border vanishes. As
/// Poisson's ratio is 0, the curvature across the border is then 0.
///
/// A triangle with three held corners is a clamp: the slope at its edges is that of the triangle's plane. At other
/// edges near a clamp, the slope is exact for linear functions, and for the function that is 0 in the clamp and, in
/// front of it, the squared distance from the clamp. `held`: per vertex, whether it is held now. `pinned`: per vertex,
/// whether it may ever be held. Only `pinned` decides which vertices a stencil has; `held` changes only weights. An
/// empty span means that no vertex is held, or may be.
std::vector<CurvatureStencil> curvature_stencils(const mesh::Sheet& sheet, std::span<const char> pinned = {},
                                                 std::span<const char> held = {});

}  // namespace weft::forces
