// What every force of the cloth shares.
#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/past.hpp"
#include "core/types.hpp"
#include "mesh/mesh.hpp"
#include "mesh/sheet.hpp"
#include "solver/assembly.hpp"
#include "solver/block_matrix.hpp"

namespace weft::forces {

/// How the part of the Jacobian that is indefinite under compression is made definite.
enum class Linearisation {
  definite,       ///< clamped to zero term by term
  abs_projected,  ///< by absolute values where edges are compressed: shorter steps, where clamped they overshoot
};

/// The forces on particles [begin, end); what is added to others is left out.
class ForceRows {
 public:
  ForceRows(std::span<solver::Quad<double>> all) : ForceRows(all, 0, static_cast<Index>(all.size())) {}
  ForceRows(std::vector<solver::Quad<double>>& all) : ForceRows(std::span(all)) {}
  /// `all`: of all particles.
  ForceRows(std::span<solver::Quad<double>> all, Index begin, Index end) : all_(all), begin_(begin), end_(end) {}

  void add(Index particle, const solver::Quad<double>& force) const {
    if (particle >= begin_ && particle < end_) all_[static_cast<std::size_t>(particle)] += force;
  }
  void subtract(Index particle, const solver::Quad<double>& force) const {
    if (particle >= begin_ && particle < end_) all_[static_cast<std::size_t>(particle)] -= force;
  }

 private:
  std::span<solver::Quad<double>> all_;
  Index begin_, end_;
};

struct LockLag;

/// One evaluation of the forces at (x, v). Quads are three numbers and zero.
struct Evaluation {
  std::span<const solver::Quad<double>> x;  ///< positions [m]
  std::span<const solver::Quad<double>> v;  ///< velocities [m/s]
  ForceRows force;                          ///< receives += f [N]
  /// Receives −(∂f/∂x + rate ∂f/∂v) [N/m], made symmetric and positive semidefinite term by term: what conjugate
  /// gradients and descent need. Of none: forces only.
  solver::AssemblyRows assembly = {};
  double rate = 0;  ///< dv/dx of the integration scheme, v = rate (x − x̂) [1/s]; 0: none
  /// What v is taken from; of none: rates are those of v at x.
  std::span<const Past> past = {};
  Linearisation linearisation = Linearisation::definite;
  /// Which of the ranges that the force was cut into this is for; kAll: all in one go.
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  std::size_t range = kAll;
  /// Velocity of the air at each particle [m/s], where it is not the same everywhere; else none.
  std::span<const solver::Quad<double>> air = {};
  /// Where the locks of a cloth's threads are linearised; without, at x.
  const LockLag* locks = nullptr;

  /// Rate of a quantity of the positions, which is `now` at x; where there is no past, that of v, `by_velocity()`.
  /// Viscosity goes by it: with ∂q/∂x v implicit Euler takes what turns by θ in a step for longer by 1 − cos θ, stiff
  /// viscosity then shortens it by that, step by step, and the work of the threads' compression came from nowhere.
  template <class Quantity, class OfPlaces, class ByVelocity>
  Quantity rate_of(const Quantity& now, const OfPlaces& of_places, const ByVelocity& by_velocity) const {
    if (past.empty()) return by_velocity();
    Quantity change = now;
    for (const Past& before : past) change = change - before.weight * of_places(before.x);
    return rate * change;
  }
};

/// A force on the particles of one cloth. `first` is the cloth's first particle in the global numbering.
class Force {
 public:
  virtual ~Force() = default;

  /// Pairs of particles that the Jacobian couples.
  virtual void couple(std::vector<std::pair<Index, Index>>& pairs) const = 0;
  /// Whether what is added to an Assembly are multiples of the unit matrix.
  virtual bool isotropic() const { return false; }
  /// Looks up where the blocks are; once, after the pattern is known.
  virtual void attach(const solver::Assembly& assembly) = 0;

  /// Cuts the particles into ranges between these bounds, which may be added to at the same time. After attach().
  virtual void cut(std::span<const Index> bounds) = 0;

  virtual void add(const Evaluation& at) const = 0;
  /// Elastic energy [J].
  virtual double energy(std::span<const Vec3> x) const = 0;

  /// Adds the part of −∂f/∂x that only hold() changes, if there is one; `add` leaves it out.
  virtual void add_constant_stiffness(solver::Assembly& /*assembly*/) const {}

  /// Adds all of −(∂f/∂x + rate ∂f/∂v) itself, indefinite under compression and unsymmetric with viscosity. For
  /// vibrations and for tests, element by element; not for air.
  virtual void add_jacobian(std::span<const Vec3> /*x*/, std::span<const Vec3> /*v*/, double /*rate*/,
                            solver::BlockMatrix& /*jacobian*/) const {}

  /// Which particles of all cloths are held in place or moved from now on: what they leave free may resist otherwise.
  /// The pattern of the Jacobian stays.
  virtual void hold(std::span<const char> /*held*/) {}
};

/// What resists motion within the sheet, and knows how far it is stretched.
class Membrane : public Force {
 public:
  /// Largest relative change of length of a piece of weft or warp.
  virtual double max_strain(std::span<const Vec3> x) const = 0;
  /// Raises heat[particle − first] to the largest strain next to it.
  virtual void strain_per_particle(std::span<const Vec3> x, std::span<float> heat) const = 0;
};

/// Lumped masses of a grid [kg], ρ times the area of each particle (ρ in kg/m²).
std::vector<double> lumped_masses(const mesh::Grid& grid, double density);
/// And of triangles, a third of each to each of its corners, with those of bands.
std::vector<double> lumped_masses(const mesh::Sheet& sheet, double density);

}  // namespace weft::forces
