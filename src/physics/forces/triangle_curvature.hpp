// Second derivatives on triangle meshes, as weighted sums of vertices.
#pragma once

#include <span>
#include <vector>

#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The curvature vectors s_uu, s_vv and s_uv of one triangle [1/m]: Σ_k weights[k] x_k, one vector per component of the
/// weights.
struct CurvatureStencil {
  std::vector<Index> vertices;  ///< the triangle's own corners come first
  std::vector<Vec3> weights;    ///< for s_uu, s_vv and s_uv [1/m²]
};

/// Returns one stencil per triangle. In a triangle of area A with edges of length l, unit tangents t and outward
/// normals n,
///
///     s_ab = 1/A Σ_edges l sym(n_a g_b),    g = n ∂s/∂n + t ∂s/∂t at the middle of the edge, a, b = u or v:
///
/// the plate element of Morley ("The Triangular Equilibrium Element in the Solution of Plate Bending Problems", 1968).
/// Its unknown slopes ∂s/∂n across the edges are replaced by weighted sums of the vertices around the edge that are
/// exact for quadratic functions. Therefore s_ab is exact for these, too; and because both triangles at an edge use the
/// same slope, a constant moment exerts no force on inner vertices. Both properties are necessary for the correct plate
/// stiffness on any mesh (measured: a quadratic through each triangle and its three neighbours, which has only the
/// first property, is 33 % too soft on crossed meshes and 6 % on Delaunay meshes at every resolution).
///
/// The slope across a border edge is free: it has the value of least energy, at which the moment about the border
/// vanishes (curvature across it 0, for ν = 0).
///
/// A triangle with three held corners is a clamp: at its edges the slope is the triangle's own. At other edges near a
/// clamp, the slope is exact for linear functions, and for the squared distance in front of the clamp (0 inside it).
/// `held`: per vertex, whether it is held now. `pinned`: per vertex, whether it may be held at any time. The vertices
/// of the stencils depend on `pinned`, but not on `held`; only weights do. Empty: no vertex.
std::vector<CurvatureStencil> curvature_stencils(const mesh::Sheet& sheet, std::span<const char> pinned = {},
                                                 std::span<const char> held = {});

}  // namespace weft::forces
