// Error of friction on a diagonal block that is about to slide.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/integrator/system.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::integrator {

/// Error of friction on a whole diagonal block. Without this error, Newton's method could end while
/// wrong friction still holds a cloth back: friction and contacts are stiff until the cloth slides
/// as a whole, so the velocity error seems small. (Measured on slopes half a degree too steep for
/// sticking: sheets slide 1.00 to 1.01 of a rigid body's distance; without this class 0.92 to
/// 0.97.) If the friction that the motion requires exceeds `Numerics::Newton::about_to_slide` times
/// the maximum friction, the error is the larger one of two forces: the residual along the
/// friction, and the required friction minus the maximum friction. All forces are sums over the
/// block. (With errors of single particles, the scene sphere_drape takes two to three times the
/// iterations.)
class Sliding {
 public:
  /// Evaluates the contact forces of a system at this stage. Returns false if there is no contact.
  bool evaluate(const System& system, const StagePoint& at);

  /// Returns this error [N] for a diagonal block, at the stage of the last evaluate(). `residual`
  /// [N]: of all particles. Returns 0 unless the block is about to slide.
  double friction_error(const solver::DiagonalBlock& rows, std::span<const Vec3> residual) const;

 private:
  // As in System::contact_forces() [N].
  std::vector<Vec3> push_, friction_;
  std::vector<double> normal_force_, limit_;
};

/// Whether constraints hold a diagonal block against sliding. A wall along which the block slides leaves two directions
/// free, so it does not hold the block.
bool is_held(const solver::DiagonalBlock& rows, std::span<const solver::ParticleConstraint> constraints);

}  // namespace weft::integrator
