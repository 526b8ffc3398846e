// Stretch and shear of cloth made of cells of four triangles around a middle.
#pragma once

#include "forces/triangle_membrane.hpp"

namespace weft::forces {

/// TriangleMembrane without its locking. Four triangles that keep their lengths keep the middle of their cell in the
/// plane of its corners: cells stay flat, and kinks between them take what bending should. Here the height w of the
/// middle above its corners, along the normal n of their diagonals, lengthens all four triangles alike and not each as
/// it leans: with m' = m − w n in place of the middle m,
///
///     ‖s_u‖² + θ w² ⟨g_u²⟩ + ‖n‖² ‖t‖² g_u² / 16 in place of ‖s_u‖²,   likewise along v,
///
/// g the gradient of the middle's weight, averaged over the cell in the first of them, and θ a tenth: tension still
/// draws middles flat. t = a − b + c − d is the twist of the cell. Two threads at opposite sides that are skew keep
/// their lengths; the line from middle to middle between them is the mean of both as vectors, and so shorter, by
/// exactly ‖t‖² / 4 of its square. Cells of parallelograms in the plane have neither w nor t: nothing changes. n = D₁ ×
/// D₂ / S with the diagonals D and S = ‖D₁ × D₂‖, of cells that are folded up to less than S₀ (S₀ + ‖D₁ × D₂‖² / S₀) /
/// 2: their triangles are more and more by themselves. (Averages against locking: Chen et al., "Locking-free Simulation
/// of Isometric Thin Plates", 2019, of strains around vertices.)
class CrossedMembrane final : public TriangleMembrane {
 public:
  /// The sheet's triangles are cells, four by four: (a, b, m), (b, c, m), (c, d, m), (d, a, m).
  CrossedMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                  const ShearParameters& shear);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void cut(std::span<const Index> bounds) override;
  /// Matrices are those of Gauss and Newton and of the stresses, without what they turn n by, the Jacobian too.
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  /// Four corners and the middle.
  struct Cell {
    std::array<Index, 5> particles;
    Vec2 bulge = Vec2::Zero();  // θ ⟨g_u²⟩, θ ⟨g_v²⟩ [1/m²]
    double least_size = 0;      // S₀ [m²]
  };
  using Five = std::array<Vec3, 5>;
  /// What counts of a height and of a skew in one triangle: θ ⟨g²⟩ and g² / 16, along weft and warp [1/m²].
  struct Bulge {
    Vec2 of_height, of_skew;
  };
  /// A cell as it lies, or as it moves.
  struct State {
    Five flat;          // corners and m'
    double height = 0;  // w
    Vec3 normal, lean;  // n, and the middle less the mean of the corners
    Vec3 twist;         // t
    double skew = 0;    // ‖n‖² ‖t‖² [m²]
    std::array<Vec3, 2> diagonals;
    double size = 0;                // S [m²]
    Vec3 direction = Vec3::Zero();  // e, of the cross product of the diagonals
    double kept = 0;                // κ, of a change of that product along e what n keeps
  };
  double strain(std::size_t triangle, std::span<const Vec3> x) const override;
  static State state_of(const Cell& cell, const Five& positions);
  static Vec3 turned(const State& state, const Vec3& product);
  static Five vectors_of(const Cell& cell, std::span<const Vec3> of);
  static Five vectors_of(const Cell& cell, std::span<const solver::Quad<double>> of);
  /// What tension does across a thread, k times this, by its length.
  using Lateral = double (*)(double length);
  using Blocks = std::array<solver::PackedBlock, 25>;  // row-major over pairs of particles
  static Gradient gradient_of(const Element& element, const Five& flat, std::size_t k);
  static Bulge bulge_of(const Cell& cell, const Element& element);
  static Vec2 lengths_of(const Gradient& s, const Bulge& bulge, const State& state);
  /// Lengths along weft and warp of triangle k of a cell as it lies, and its shear.
  Vec3 strains_of(std::size_t cell, std::size_t k, const State& state) const;
  static void pull_back(const State& state, Five& force, double along_height, double along_skew);
  static void push_forward(const State& state, Five& flat, double& height, double& skew);
  Blocks blocks_of(std::size_t cell, const State& state, double rate, Lateral lateral_of, bool definite) const;

  std::vector<Cell> cells_;
  std::vector<std::array<Index, 25>> cell_blocks_;  // of pairs in the order of their numbers
  Ranges ranges_;                                   // of cells
};

}  // namespace weft::forces
