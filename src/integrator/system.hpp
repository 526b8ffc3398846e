// What the integrator knows of the thing it integrates: M x'' = f(x, x') with constraints.
#pragma once

#include <span>
#include <vector>

#include "core/past.hpp"
#include "core/types.hpp"
#include "solver/linear_system.hpp"

namespace weft::integrator {

/// Positions [m] and velocities [m/s] of all particles. Behind the particles' positions others may stand, of what is
/// not integrated: they are left alone.
struct State {
  std::vector<Vec3> x, v;
};

/// Where the implicit equation of a step is evaluated.
struct StagePoint {
  std::span<const Vec3> x;      ///< stage positions
  std::span<const Vec3> v;      ///< stage velocities, (x − x̂) / β
  std::span<const Vec3> x_end;  ///< positions at the end of the step that this stage leads to; contacts act there
  double rate = 0;              ///< dv/dx = 1/β [1/s]
  double end_rate = 1;          ///< dx_end/dx: 1, or 2 for the midpoint rule
  /// What x̂ is made of; empty with the midpoint rule, with which ∂q/∂x v is the change of a quadratic q in the step.
  std::span<const Past> past = {};
};

class System {
 public:
  virtual ~System() = default;

  virtual std::span<const double> masses() const = 0;

  /// Adds forces of a step that hang neither on positions nor on velocities, beside the weight [N].
  virtual void constant_forces(std::span<Vec3> force) const = 0;

  /// Adds all other forces at a stage [N]. What a system remembers between calls may change here only as far as it does
  /// not change results.
  virtual void forces(const StagePoint& at, std::span<Vec3> force) = 0;

  /// As `forces`, but what the last linearise() has put its tangent for is so here: what a search along the solution of
  /// that linear system must see.
  virtual void linear_forces(const StagePoint& at, std::span<Vec3> force) { forces(at, force); }

  /// As `linear_forces`, and fills the matrix of linear_system() with rate² M − ∂f/∂x − rate ∂f/∂v and its terms with
  /// what stands beside it. `iteration`: of Newton's method, from 0 in each solve. Forces that lag behind the positions
  /// catch up here, before they are added.
  virtual void linearise(const StagePoint& at, int iteration, std::span<Vec3> force) = 0;

  /// Whether translating a part changes no force but by terms and constraints of linear_system(), and by air.
  virtual bool is_translation_invariant() const { return false; }

  /// Adds what contacts have in `forces`, friction apart from what pushes, and the most that friction can be by the
  /// loads that it goes by [N]. False, and nothing is added, where nothing touches.
  virtual bool contact_forces(const StagePoint& at, std::span<Vec3> push, std::span<Vec3> friction,
                              std::span<double> limit) const {
    (void)at, (void)push, (void)friction, (void)limit;
    return false;
  }

  /// Of a step that has been solved: makes the terms of linear_system() those of impacts, and adds to its right hand
  /// side; the solution is what impacts have changed of velocities [m/s]. False if there is no impact.
  virtual bool find_impacts(const StagePoint& at, const StepStart& start, std::span<Vec3> right_side) {
    (void)at, (void)start, (void)right_side;
    return false;
  }

  /// What linearise() fills; its constraints are the integrator's.
  virtual solver::LinearSystem& linear_system() = 0;
};

/// A particle held in some directions: at the end of the step it is at `x_end`, moving with `v_end`, as far as the
/// constraint reaches.
struct HeldParticle {
  solver::ParticleConstraint constraint;
  Vec3 x_end, v_end;
};

}  // namespace weft::integrator
