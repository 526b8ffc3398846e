// Ropes: chains of particles with stretch and bending stiffness and air drag.
#pragma once

#include <array>

#include "physics/forces/bend_damping.hpp"
#include "physics/forces/force.hpp"

namespace weft::forces {

struct RopeForceParameters {
  double stretch = 0;            ///< force per strain, EA [N]
  double stretch_viscosity = 0;  ///< η, force per rate of strain [N·s]
  double bend = 0;               ///< bending stiffness, EI [N·m²]
  double bend_viscosity = 0;     ///< moment per rate of curvature [N·m²·s]
  double air_density = 0;        ///< ρ [kg/m³]; 0: no air
  Vec3 wind = Vec3::Zero();      ///< velocity of the air [m/s], if Evaluation::air_velocity is empty
  double drag = 0;               ///< c, drag coefficient across the rope
  double diameter = 0;           ///< d, for drag [m]
};

/// The forces on one rope: a chain of particles. A piece is the part between two consecutive particles.
///
/// Stretch: a piece of length l and rest length r has the energy ½ EA r (l/r − 1)² and the viscous tension η d(l/r)/dt.
/// Bending: each particle between two pieces has the energy ½ EI L ‖s''‖². s'' is the second difference of the
/// positions with the rest lengths as spacings, and L is the mean of both rest lengths. At clamps, L is half of the
/// rest length on the free side, as in Bend. The rope is straight at rest. For the viscosity of bending
/// see BendDamping. Air: the drag on a piece is −½ ρ c d l ‖v_n‖ v_n; each end gets half of it. v_n
/// is the mean velocity of both ends relative to the air, without its component along the piece.
class RopeForce final : public Membrane {
 public:
  /// `lengths`: rest lengths of the pieces [m]; `closed`: the last piece connects the last particle to the first.
  RopeForce(std::span<const double> lengths, bool closed, Index first, const RopeForceParameters& parameters);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  void add_constant_stiffness(solver::Assembly& assembly) const override;
  void set_held(std::span<const char> held) override;

  /// Sets the rest lengths to `ratio` times the initial ones. Returns whether this changes the constant stiffness.
  bool set_length_ratio(double ratio);
  double length_ratio() const { return length_ratio_; }

 private:
  void for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const override;
  struct Piece {
    std::array<Index, 2> particles;
    double initial_length;  // rest length at construction [m]
    double rest;            // r, current rest length [m]
    double elasticity;      // EA / r [N/m]
    double viscosity;       // η / r [N·s/m]
    Index block = 0;
  };
  struct BendElement {
    std::array<Index, 3> particles;
    double before, after;                      // initial rest lengths of the pieces 01 and 12 [m]
    double initial_length;                     // L at the initial rest lengths [m]
    std::array<double, 3> weights{};           // of s'' [1/m²]
    double length = 0;                         // L [m]
    std::array<Index, 3> scalars{}, blocks{};  // of the pairs 01, 12, 20
  };
  void add_stretch(const Piece& piece, const Evaluation& at) const;
  void add_air(const Piece& piece, const Evaluation& at) const;
  void add_bend(const BendElement& bend, const Evaluation& at) const;
  void compute_weights(BendElement& bend) const;

  RopeForceParameters parameters_;
  BendDamping damping_;
  double length_ratio_ = 0;  // of current to initial rest lengths; 0: not set yet
  std::vector<Piece> pieces_;
  std::vector<BendElement> bends_;
};

/// Lumped masses [kg]: each end of a piece gets half of the mass of the piece. `lengths`, `closed`:
/// as in RopeForce. `mass`: per length [kg/m].
std::vector<double> lumped_masses(std::span<const double> lengths, bool closed, double mass);

}  // namespace weft::forces
