// Interface of the internal forces and the air drag of a cloth, a rope or a rigid body.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/past.hpp"
#include "core/types.hpp"
#include "physics/mesh/mesh.hpp"
#include "physics/mesh/sheet.hpp"
#include "physics/solver/assembly.hpp"
#include "physics/solver/block_matrix.hpp"

namespace weft::forces {

/// Adds forces to the entries of the particles [begin, end). Ignores forces on other particles, to
/// which another thread may add at the same time.
class ForceRows {
 public:
  ForceRows(std::span<solver::PaddedVec3<double>> all) : ForceRows(all, 0, static_cast<Index>(all.size())) {}
  ForceRows(std::vector<solver::PaddedVec3<double>>& all) : ForceRows(std::span(all)) {}
  /// `all`: forces of all particles.
  ForceRows(std::span<solver::PaddedVec3<double>> all, Index begin, Index end) : all_(all), begin_(begin), end_(end) {}

  void add(Index particle, const solver::PaddedVec3<double>& force) const {
    if (particle >= begin_ && particle < end_) all_[static_cast<std::size_t>(particle)] += force;
  }
  void subtract(Index particle, const solver::PaddedVec3<double>& force) const {
    if (particle >= begin_ && particle < end_) all_[static_cast<std::size_t>(particle)] -= force;
  }

 private:
  std::span<solver::PaddedVec3<double>> all_;
  Index begin_, end_;
};

struct LockLinearisation;

/// Input and output of one evaluation of the forces at (x, v).
struct Evaluation {
  std::span<const solver::PaddedVec3<double>> x;  ///< positions [m]
  std::span<const solver::PaddedVec3<double>> v;  ///< velocities [m/s]
  ForceRows force;                                ///< receives the forces f [N]
  /// Receives −(∂f/∂x + rate ∂f/∂v) [N/m] without the part that Force::add_constant_stiffness()
  /// adds. Each force approximates its matrix by a symmetric one that, together with the constant
  /// part, is positive semidefinite; conjugate gradients and the line search require this. If
  /// default-constructed: forces only.
  solver::AssemblyRows assembly = {};
  /// dv/dx of the integration method [1/s]: v = rate (x − x̂), where x̂ is constant in a step; 0: v does not depend on
  /// x.
  double rate = 0;
  /// Earlier positions whose weighted sum is x̂ (see EarlierPositions). Empty: the rate of a strain q is ∂q/∂x v.
  std::span<const EarlierPositions> past = {};
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  /// Index of the range of Force::partition() to evaluate; kAll: all particles.
  std::size_t range = kAll;
  /// Velocity of the air at each particle [m/s]. If empty, Air and RopeForce use their own uniform wind.
  std::span<const solver::PaddedVec3<double>> air_velocity = {};
  /// Extensions of threads at which StretchLimit linearises its stress for the matrix; null: at x. In both cases,
  /// `force` receives the exact forces at x.
  const LockLinearisation* locks = nullptr;

  /// Rate of change dq/dt of a function q of the positions. `now` is q(x), at_positions(y) returns q at earlier
  /// positions y, and by_velocity() returns ∂q/∂x v. If `past` is empty, the rate is ∂q/∂x v;
  /// otherwise it is the difference quotient of EarlierPositions, because ∂q/∂x v adds energy: if an edge turns
  /// by θ in a step of implicit Euler, ∂q/∂x v counts the turn as a lengthening by the fraction
  /// 1 − cos θ. Stiff viscosity would then shorten the edge by that fraction in every step.
  template <class Quantity, class AtPositions, class ByVelocity>
  Quantity rate_of(const Quantity& now, const AtPositions& at_positions, const ByVelocity& by_velocity) const {
    if (past.empty()) return by_velocity();
    Quantity change = now;
    for (const EarlierPositions& before : past) change = change - before.weight * at_positions(before.x);
    return rate * change;
  }
};

/// A force on the particles of one cloth, rope or rigid body. In the constructors of forces,
/// `first` is the index of the first of these particles in the global numbering.
class Force {
 public:
  virtual ~Force() = default;

  /// Appends the pairs of particles that the Jacobian couples, in either order; pairs may repeat.
  virtual void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const = 0;
  /// Whether everything that the force adds to an Assembly is a multiple of the identity.
  virtual bool isotropic() const { return false; }
  /// Looks up the blocks and scalars of the pairs from append_couplings(). Call once, when the
  /// sparsity pattern is known.
  virtual void attach(const solver::Assembly& /*assembly*/) {}

  /// Prepares ranges of particles that threads may evaluate at the same time: range r is
  /// [bounds[r], bounds[r + 1]). `bounds` ascends, and the ranges contain all particles of the
  /// force. Call after attach(). By default, every range evaluates all elements.
  virtual void partition(std::span<const Index> /*bounds*/) {}

  /// Adds the forces and, if `at.assembly` is set, the matrix; see Evaluation.
  virtual void add(const Evaluation& at) const = 0;
  /// Elastic energy at x [J].
  virtual double energy(std::span<const Vec3> x) const = 0;

  /// Adds the part of −∂f/∂x that does not depend on x, if there is one. Only set_held() and
  /// RopeForce::set_length_ratio() change this part. add() adds the forces of this part, but not its matrix.
  virtual void add_constant_stiffness(solver::Assembly& /*assembly*/) const {}

  /// For vibrations and tests: adds the exact −(∂f/∂x + rate ∂f/∂v), with rates of strain as if `Evaluation::past` were
  /// empty. This matrix may be indefinite under compression and unsymmetric with viscosity.
  /// Exceptions: CrossedMembrane omits parts of it, and RopeForce omits air drag; Air and Rigidity add
  /// nothing. If `rate` is 0, the damping of bending is omitted.
  virtual void add_jacobian(std::span<const Vec3> /*x*/, std::span<const Vec3> /*v*/, double /*rate*/,
                            solver::BlockMatrix& /*jacobian*/) const {}

  /// Sets which particles are held (fixed, or moved along a path). Held particles may form a clamp, which changes the
  /// bending stiffness of the free particles beside it. `held`: per particle, in the global
  /// numbering. The sparsity pattern of the Jacobian does not change.
  virtual void set_held(std::span<const char> /*held*/) {}
};

/// Appends all pairs of these particles, for Force::append_couplings().
void append_pairs_of(std::span<const Index> particles, std::vector<std::pair<Index, Index>>& pairs);

/// Lower bound of length / rest length of a piece of thread or rope. It keeps the stiffness of a piece of length 0,
/// which has no direction, finite.
inline constexpr double kMinStretch = 1e-12;

/// Exact −(∂f/∂x + rate ∂f/∂v) of a spring with viscosity [N/m], for Force::add_jacobian(). `d`, `w`: its vector [m]
/// and the relative velocity of its ends [m/s]; `elasticity`, `viscosity`: force per lengthening [N/m] and per rate of
/// lengthening [N·s/m].
Mat3 spring_stiffness(const Vec3& d, const Vec3& w, double rest_length, double elasticity, double viscosity,
                      double rate);

/// A force against strain in the plane of a sheet or along a rope. It also measures this strain.
class Membrane : public Force {
 public:
  /// Largest relative change of length of a piece of weft, warp or rope, in absolute value.
  double max_strain(std::span<const Vec3> x) const;
  /// Raises strains[particle − first] to the largest |strain| of the pieces or triangles at the
  /// particle, unless the entry is larger already.
  void strain_per_particle(std::span<const Vec3> x, std::span<float> strains) const;

 protected:
  explicit Membrane(Index first) : first_(first) {}
  using VisitStrain = std::function<void(double strain, std::span<const Index> particles)>;
  /// Calls visit(|strain|, particles) for each piece or triangle.
  virtual void for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const = 0;

 private:
  Index first_;
};

/// Lumped masses of a grid [kg]: ρ times the area of each particle. `density`: ρ [kg/m²].
std::vector<double> lumped_masses(const mesh::Grid& grid, double density);
/// Lumped masses of a sheet [kg]: a triangle gives a third of its mass to each corner, and a piece of a band or seam
/// allowance half of its mass to each end. `density`: ρ of cloth without reinforcements [kg/m²].
std::vector<double> lumped_masses(const mesh::Sheet& sheet, double density);

}  // namespace weft::forces
