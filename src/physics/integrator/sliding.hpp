// Error of friction on a diagonal block that is about to slide.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/integrator/system.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::integrator {

/// Without this class, Newton's method could end while wrong friction still holds a cloth back: friction and contacts
/// are stiff until the cloth slides as a whole, so the velocity error seems small. (Measured on slopes half a degree
/// too steep for sticking: sheets slide 1.00 to 1.01 of a rigid body's distance; without this class 0.92 to 0.97.) If
/// friction is near its limit, the error is the larger one of two forces: the residual along the friction, and the
/// friction in excess of what the normal force allows. Both are sums over a diagonal block: with errors of single
/// particles, the scene sphere_drape takes two to three times the iterations.
class Sliding {
 public:
  /// Evaluates the contact forces of a system at this stage. Returns false if there is no contact.
  bool evaluate(const System& system, const StagePoint& at);

  /// Error [N] of the friction on a diagonal block as a whole, from its residual [N]; 0 unless the block is about to
  /// slide.
  double friction_error(const solver::DiagonalBlock& rows, std::span<const Vec3> residual) const;

 private:
  std::vector<Vec3> push_, friction_;  // [N]
  std::vector<double> limit_;          // [N]
};

/// Whether constraints hold a diagonal block against sliding. A wall along which the block slides leaves two directions
/// free, and does not count.
bool is_held(const solver::DiagonalBlock& rows, std::span<const solver::ParticleConstraint> constraints);

}  // namespace weft::integrator
