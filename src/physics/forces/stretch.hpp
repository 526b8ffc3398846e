// Weft and warp stretch, elastic and viscous.
#pragma once

#include <array>

#include "physics/forces/force.hpp"
#include "physics/forces/lanes.hpp"
#include "physics/forces/ranges.hpp"

namespace weft::forces {

struct StretchParameters {
  double weft = 0, warp = 0;  ///< stiffness k1, k2 [N/m]
  double viscosity = 0;       ///< η, stress per strain rate, both directions [N·s/m]
};

/// Tension along the grid lines: Eq. (1), entries 11 and 22, of Etzmuß et al. (2001), with the spring formula of its
/// section "Elastic Model".
///
/// An edge d = x_j − x_i of rest length l that covers the area A has the energy ½ k A (‖d‖/l − 1)², k = k1 or k2. The
/// force density of the paper, k/l² [(x_i − x_j) − l (x_i − x_j)/‖x_i − x_j‖], acts on x_j; times A, it is the force of
/// an edge on x_j. Viscosity has the same form, with the rate of strain instead of the strain: the dissipation is
/// ½ η A (d(‖d‖/l)/dt)².
class Stretch final : public Membrane {
 public:
  Stretch(const mesh::Grid& grid, Index first, const StretchParameters& parameters);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

 private:
  void for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const override;
  struct Edge {
    Index i, j;
    double rest_length;  // l [m]
    double elasticity;   // k A / l² [N/m]
    double viscosity;    // η A / l² [N·s/m]
  };
  /// Four edges.
  struct Edges {
    IndexLanes i{}, j{}, block{};
    Lanes rest_length{}, elasticity{}, viscosity{};  // stiffnesses are 0 in unused lanes
  };

  template <class Body>
  void for_each_edge(const Body& body) const;

  bool viscous_;
  std::size_t count_ = 0;  // of edges
  std::vector<Edges> packs_;
  Ranges ranges_;  // of packs
};

}  // namespace weft::forces
