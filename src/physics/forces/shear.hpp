// Shear between weft and warp, elastic and viscous.
#pragma once

#include <array>

#include "physics/forces/force.hpp"
#include "physics/forces/lanes.hpp"

namespace weft::forces {

struct ShearParameters {
  double modulus = 0;    ///< μ [N/m]; the shear modulus of linear elasticity is μ / 2
  double viscosity = 0;  ///< η, shear stress per rate of ½ ⟨s_u, s_v⟩ [N·s/m]
};

/// Eq. (1), entry 12, of Etzmuß et al. (2001): stress ½ μ ⟨s_u, s_v⟩ [N/m], from the energy density ¼ μ ⟨s_u, s_v⟩².
///
/// s_u and s_v are the derivatives of the positions along weft and warp. In the middle of each
/// cell, this class computes each derivative as the mean of the differences along two opposite
/// edges. The error is O(l²) for a spacing l: a test measures order 2. The paper uses central
/// differences at the particles, (x_{i+1,j} − x_{i−1,j}) / (2 l), and states O(l³). Central
/// differences vanish for every displacement that repeats at every second particle, so the paper's
/// shear does not resist such displacements. In this class, both differences vanish only for the
/// checkerboard pattern, which the edges of Stretch resist.
class Shear final : public Force {
 public:
  Shear(const mesh::Grid& grid, Index first, const ShearParameters& parameters);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  struct Cell {
    std::array<Index, 4> corners;  // in the order (0,0), (1,0), (0,1), (1,1) of (weft, warp)
    double lu, lv;                 // rest size [m]
    double elasticity;             // ½ μ A, A = lu lv [N·m]
    double viscosity;              // ½ η A [N·m·s]
  };

  struct Strain {
    Vec3 su, sv;
    double c;  // ⟨s_u, s_v⟩
  };
  static Strain strain(const Cell& cell, std::span<const Vec3> x);

  /// Four cells.
  struct Cells {
    std::array<IndexLanes, 4> corners{};
    std::array<IndexLanes, 6> blocks{};  // of the pairs of corners 01, 02, 03, 12, 13, 23
    Lanes half_u{}, half_v{};            // 1 / (2 lu), 1 / (2 lv) [1/m]
    Lanes elasticity{}, viscosity{};     // as in Cell; 0 in unused lanes
  };
  struct StrainLanes {
    VecLanes su, sv;
  };
  template <class Points>
  static StrainLanes strain(const Cells& cells, Points x);
  static void add_stiffness(const Cells& cells, const StrainLanes& s, const Lanes& c, const Evaluation& at);

  template <class Body>
  void for_each_cell(const Body& body) const;

  bool viscous_;
  std::vector<std::array<double, 2>> sizes_;  // lu, lv of each cell
  std::vector<Cells> packs_;
  Ranges ranges_;  // of packs
};

}  // namespace weft::forces
