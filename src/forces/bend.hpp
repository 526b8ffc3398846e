// Bending of the sheet as a plate: elastic, viscous, and with the dry friction of yarn on yarn.
#pragma once

#include <array>

#include "forces/bend_damping.hpp"
#include "forces/force.hpp"

namespace weft::forces {

/// Seed "Elastic Model", bending f = −B Δ² along the normal (restoring sign): a plate with ν = 0, energy density
/// ½ B (‖s_uu‖² + 2 ‖s_uv‖² + ‖s_vv‖²), by central differences on lines and in cells; free edges come out of the
/// energy.
///
/// The full second differences are used, not their part along N: on an inextensible sheet they are equal, and the
/// energy becomes quadratic in the positions, with a constant, definite Jacobian that is assembled once (Bergou et al.,
/// "A Quadratic Bending Model for Inextensible Surfaces", 2006). What is added in the plane is B/l² against k: for
/// cotton at l = 1 cm, 0.5 N/m against 1000 N/m.
///
/// A difference stands for half a spacing to either side of its middle. Where the middle and one end are held, that
/// side keeps its direction, and all of the turn happens in the half spacing that is free: the clamp acts at the last
/// held particle. Counted over both halves, as if nothing were held, it acts half a spacing behind, an error of first
/// order. Viscosity and friction: see BendDamping.
class Bend final : public Force {
 public:
  Bend(const mesh::Grid& grid, Index first, const BendParameters& parameters);

  void couple(std::vector<std::pair<Index, Index>>& pairs) const override;
  bool isotropic() const override { return true; }
  void attach(const solver::BlockMatrix& matrix) override;
  void add(const Evaluation& at) const override;
  double energy(std::span<const Vec3> x) const override;

  /// All of the elastic part.
  void add_constant_stiffness(solver::BlockMatrix& matrix) const override;
  void hold(std::span<const char> held) override;

 private:
  /// A second difference Σ w_k x_k [1/m²·m] that stands for `area`; unused entries repeat particle 0 with weight 0.
  struct Difference {
    std::array<Index, 4> particles;
    std::array<double, 4> weights;
    double area;
    int count;
  };
  void lay_out(std::span<const char> held);
  void add_line(const std::array<Index, 3>& particles, double before, double after, double width,
                std::span<const char> held);
  Vec3 damping(std::size_t index, const Vec3& curvature, const Evaluation& at) const;
  void add_blocks(std::size_t index, const Mat3& stiffness, solver::BlockMatrix& matrix) const;

  mesh::Grid grid_;
  Index first_;
  double rigidity_;
  BendDamping damping_;
  std::vector<Difference> differences_;
  std::vector<std::array<solver::Slot, 16>> slots_;  // row-major over pairs of particles
};

}  // namespace weft::forces
