// Bending of the sheet as a plate: elasticity, viscosity, and dry friction between yarns.
#pragma once

#include <array>

#include "physics/forces/bend_damping.hpp"
#include "physics/forces/force.hpp"
#include "physics/forces/ranges.hpp"

namespace weft::forces {

/// The bending force f = −B Δ² s along the normal N of the surface s(u, v) (Etzmuß et al. 2001, "Elastic Model") is the
/// restoring force of a plate with rigidity B, Poisson's ratio ν = 0 and energy density ½ B (‖s_uu‖² + 2 ‖s_uv‖² +
/// ‖s_vv‖²). This class discretises the energy by central differences on grid lines (s_uu, s_vv) and in cells (s_uv).
/// The energy also determines the forces at free edges.
///
/// The energy contains the full second derivatives, not only their components along N; on an
/// inextensible sheet, the second derivatives are parallel to N. Thus the energy is quadratic in
/// the positions. Its Hessian is constant and positive semidefinite, and is assembled once (Bergou
/// et al., "A Quadratic Bending Model for Inextensible Surfaces", 2006). The in-plane components
/// resist differences of strain between neighbouring edges, at most as much as an additional
/// stretch stiffness of 4 B/l²: for cotton at a spacing l = 1 cm, 0.4 N/m beside a stretch
/// stiffness of 800 N/m.
///
/// A second difference on a grid line covers half a spacing on either side of its middle particle.
/// If the middle particle and exactly one of its two neighbours are held, the cloth keeps its
/// direction on the held side. Then the difference covers only the half spacing on the free side,
/// so that the clamp acts at the last held particle. If the difference covered both halves, the
/// clamp would act half a spacing farther inside, which is an error of first order in the spacing.
/// For viscosity and friction see BendDamping.
class Bend final : public Force {
 public:
  Bend(const mesh::Grid& grid, Index first, const BendParameters& parameters);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  bool isotropic() const override { return true; }
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;

  /// Adds the whole elastic stiffness.
  void add_constant_stiffness(solver::Assembly& assembly) const override;
  void set_held(std::span<const char> held) override;

 private:
  /// Four second differences Σ weights[k] x_k [1/m], each with the area that it covers (for s_uv: twice this area).
  template <std::size_t Count>
  struct Differences {
    std::array<IndexLanes, Count> particles{};
    std::array<Lanes, Count> weights{};
    Lanes area{};                                             // [m²]
    std::array<IndexLanes, Count*(Count - 1) / 2> scalars{};  // per pair 01, 02, ...: Assembly::scalar()
  };
  /// All differences of one kind: along lines, or in cells.
  template <std::size_t Count>
  struct List {
    std::vector<Differences<Count>> packs;
    std::size_t size = 0;
    Ranges ranges;

    void add(const std::array<Index, Count>& particles, const std::array<double, Count>& weights, double area);
  };
  void add_line(const std::array<Index, 3>& particles, double before, double after, double width,
                std::span<const char> held);
  template <std::size_t Count>
  void add(const Differences<Count>& differences, const Evaluation& at) const;
  template <class Body>
  void for_all(const Body& body) const;

  mesh::Grid grid_;
  Index first_;
  double rigidity_;
  BendDamping damping_;
  List<3> lines_;
  List<4> cells_;
};

}  // namespace weft::forces
