// The integrator's interface to the physical system: M x'' = f(x, x') with constraints.
#pragma once

#include <span>
#include <vector>

#include "core/past.hpp"
#include "core/types.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::integrator {

/// Positions [m] and velocities [m/s] of all particles. After the particles, x may have more
/// entries, for points that the integrator does not change.
struct State {
  std::vector<Vec3> x, v;
};

/// Point at which the implicit equation of a step is evaluated.
struct StagePoint {
  std::span<const Vec3> x;      ///< stage positions
  std::span<const Vec3> v;      ///< stage velocities, (x − x̂) / β as in Stepper
  std::span<const Vec3> x_end;  ///< positions at the end of the step, which follow from x; contacts act there
  double rate = 0;              ///< dv/dx = 1/β [1/s]
  double end_rate = 1;          ///< dx_end/dx: 1, or 2 for the midpoint rule
  /// Earlier positions of which x̂ is the weighted sum; the rate of a quantity q(x) follows from them (see
  /// EarlierPositions). Empty for the midpoint rule: there the rate is ∂q/∂x v, which for quadratic q is exactly the
  /// mean rate over the step.
  std::span<const EarlierPositions> past = {};
};

/// The physical system of a Stepper. Spans have one entry per particle.
class System {
 public:
  virtual ~System() = default;

  /// Masses of the particles [kg].
  virtual std::span<const double> masses() const = 0;

  /// Adds the forces of a step that depend neither on positions nor on velocities [N], without the
  /// weight, which the integrator adds.
  virtual void constant_forces(std::span<Vec3> force) const = 0;

  /// Adds all other forces at a stage [N]. May update caches of the system, but must not change the results of later
  /// calls.
  virtual void forces(const StagePoint& at, std::span<Vec3> force) = 0;

  /// As forces(), but evaluates the tangent of each force that the last linearise() replaced by its
  /// tangent. A line search along the solution of the linear system must use these forces.
  virtual void linear_forces(const StagePoint& at, std::span<Vec3> force) { forces(at, force); }

  /// Does what linear_forces() does, and sets the matrix and the terms of linear_system() to a
  /// positive definite approximation of rate² M − ∂f/∂x − rate ∂f/∂v. First updates what stays
  /// constant between linearisations, such as the normal forces that limit friction. `iteration`:
  /// number of Newton iterations before this one, in this call of Stepper::step() and, if it
  /// continues a paused solve, in the call that paused; earlier calls do not count.
  virtual void linearise(const StagePoint& at, int iteration, std::span<Vec3> force) = 0;

  /// Whether translating a diagonal block changes no force except those of terms, constraints and
  /// air.
  virtual bool is_translation_invariant() const { return false; }

  /// Adds the contact part of forces() [N] at each particle: friction to `friction`, all other contact forces to
  /// `push`, their magnitudes to `normal_force`, and the largest friction that they allow to `limit`. Of the last two,
  /// only sums over diagonal blocks have a meaning. Returns false, and adds nothing, if there is no contact.
  virtual bool contact_forces(const StagePoint& at, std::span<Vec3> push, std::span<Vec3> friction,
                              std::span<double> normal_force, std::span<double> limit) const {
    (void)at, (void)push, (void)friction, (void)normal_force, (void)limit;
    return false;
  }

  /// After a solved step: replaces the terms of linear_system() by those of impacts, and adds their
  /// right hand side [N/s]. The solution of this system is the change δ/h of velocities by impacts
  /// [m/s] (see Stepper). Returns false if there is no impact; then `right_side` does not change.
  virtual bool find_impacts(const StagePoint& at, const StepStart& start, std::span<Vec3> right_side) {
    (void)at, (void)start, (void)right_side;
    return false;
  }

  /// The system that linearise() fills. The integrator sets its constraints.
  virtual solver::LinearSystem& linear_system() = 0;
};

/// A particle that is held in the directions that `constraint` does not leave free. In these
/// directions, the particle ends the step at `x_end` [m] with the velocity `v_end` [m/s].
struct HeldParticle {
  solver::ParticleConstraint constraint;
  Vec3 x_end, v_end;
};

}  // namespace weft::integrator
