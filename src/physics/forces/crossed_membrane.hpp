// Stretch and shear of cloth whose cells consist of four triangles around a middle vertex.
#pragma once

#include "physics/forces/triangle_membrane.hpp"

namespace weft::forces {

/// TriangleMembrane without membrane locking (spurious bending stiffness). A cell whose four
/// triangles do not stretch bends only along a diagonal: if the corners a, b, c, d lie in a plane,
/// the middle m lies in it, too. Therefore, with stiff threads, a TriangleMembrane bends along weft
/// or warp only between cells. In this class, w is the height of m above the mean of the corners,
/// along the normal n of both diagonals. The height adds the same amount to the squared lengths of
/// the threads in all four triangles; the inclination of each triangle does not matter. The
/// derivatives s_u and s_v are those of the cell with its middle moved to m' = m − w n, and
///
///     ‖s_u‖² + θ w² ⟨g_u²⟩ + ‖n‖² ‖t‖² g_u² / 16   replaces ‖s_u‖²,   likewise along v,
///
/// where g is the gradient of the middle's barycentric coordinate in a triangle, and ⟨⟩ is the
/// average over the four triangles of the cell. θ = kHeightFraction is positive, so that tension
/// flattens cells. t = a − b + c − d is the twist of the cell. If two opposite sides p and q are
/// skew, the thread halfway between them has the vector (p + q) / 2. ‖(p + q) / 2‖² is ‖t‖²/4 less
/// than the mean of ‖p‖² and ‖q‖²; the last term compensates for this difference. In a plane
/// parallelogram, w = 0 and t = 0, and the energy is that of a TriangleMembrane. The normal is
/// n = D₁ × D₂ / S with the diagonals D₁ = c − a and D₂ = d − b and S = ‖D₁ × D₂‖. A cell with
/// ‖D₁ × D₂‖ < S₀ is folded; then S = (S₀ + ‖D₁ × D₂‖² / S₀) / 2, so that ‖n‖ and thus the terms of
/// w and t fall to zero as the cell folds. (Against the same locking, Chen et al., "Locking-free
/// Simulation of Isometric Thin Plates", 2019, average strains around vertices.)
class CrossedMembrane final : public TriangleMembrane {
 public:
  /// The triangles of the sheet must form cells of four consecutive triangles: (a, b, m), (b, c,
  /// m), (c, d, m), (d, a, m).
  CrossedMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                  const ShearParameters& shear);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  /// The matrix and add_jacobian() contain the Gauss-Newton part and the geometric stiffness of
  /// elastic stresses. They omit the geometric stiffness from changes of n, and that of viscous
  /// stresses. The matrix also omits the negative parts of the geometric stiffness, so that it is
  /// positive semidefinite.
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  struct Cell {
    std::array<Index, 5> particles;
    Vec2 height_weight = Vec2::Zero();  // θ ⟨g_u²⟩, θ ⟨g_v²⟩ [1/m²]
    double min_size = 0;                // S₀ [m²]
  };
  using CellVectors = std::array<Vec3, 5>;
  /// Factors of w² and of the skew in one triangle: θ ⟨g²⟩ and g² / 16, along weft and warp [1/m²].
  struct CellWeights {
    Vec2 of_height, of_skew;
  };
  /// Geometry of a cell.
  struct State {
    CellVectors flat;            // corners and m'
    double height = 0;           // w
    Vec3 normal, middle_offset;  // n; the middle minus the mean of the corners
    Vec3 twist;                  // t
    double skew = 0;             // ‖n‖² ‖t‖² [m²]
    std::array<Vec3, 2> diagonals;
    double size = 0;                // S [m²]
    Vec3 direction = Vec3::Zero();  // e, unit vector of the cross product of the diagonals
    double kept_change = 0;         // κ: e·δn = κ e·δ(D₁ × D₂) / S; 0 if the cell is not folded
  };
  double strain(std::size_t triangle, std::span<const Vec3> x) const override;
  static State state_of(const Cell& cell, const CellVectors& positions);
  static Vec3 normal_change(const State& state, const Vec3& product);
  template <class Vectors>
  static CellVectors vectors_of(const Cell& cell, const Vectors& of);
  /// Stiffness across a thread from its tension, relative to its stretch stiffness, as a function of its length / rest
  /// length.
  using Lateral = double (*)(double length);
  using Blocks = std::array<solver::PackedBlock, 25>;  // row-major over pairs of particles
  static Gradient gradient_of(const Element& element, const CellVectors& flat, std::size_t k);
  static CellWeights cell_weights_of(const Cell& cell, const Element& element);
  static Vec2 lengths_of(const Gradient& s, const CellWeights& cell_weights, const State& state);
  /// Length / rest length along weft and warp of triangle k of a cell, and its shear ⟨s_u, s_v⟩.
  Vec3 strains_of(std::size_t cell, std::size_t k, const State& state) const;
  static void pull_back(const State& state, CellVectors& force, double along_height, double along_skew);
  static void push_forward(const State& state, CellVectors& flat, double& height, double& skew);
  Blocks blocks_of(std::size_t cell, const State& state, double rate, Lateral lateral_of, bool definite) const;

  std::vector<Cell> cells_;
  std::vector<std::array<Index, 25>> cell_blocks_;  // at 5 a + b: of the pair (a, b), if particles[a] < particles[b]
  Ranges ranges_;                                   // of cells
};

}  // namespace weft::forces
