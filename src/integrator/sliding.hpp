// Whether friction holds a part of the system back by more, or less, than it can.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "integrator/system.hpp"
#include "solver/linear_system.hpp"

namespace weft::integrator {

/// What is left of an equation may be hidden by friction: cloth that sticks is held stiffly, up to where it lets go as
/// a whole, and what pushes it is stiffer still. So where friction is near its limit the momentum counts that is
/// missing along it, and the friction that the motion takes beyond what its load allows. By a preconditioned residual
/// alone, sheets that had fallen by a millimetre on slopes half a degree too steep were solved while they stuck, for up
/// to five steps: 0.92 to 0.97 of a block's way, and 0.57 with velocity constraints; so 1.00 to 1.01, with 3 and 0 %
/// more iterations. Asking that of particles at their limit, one by one or as a piece, sphere_drape takes two to three
/// times the iterations.
class Sliding {
 public:
  /// Takes the forces of the contacts of a system at this stage. False where nothing touches.
  bool evaluate(const System& system, const StagePoint& at);

  /// Force [N] by which friction is wrong for a part as a whole, by its residual [N]; 0 unless it is about to slide.
  double wrong_friction(const solver::Part& rows, std::span<const Vec3> residual) const;

 private:
  std::vector<Vec3> push_, friction_;  // [N]
  std::vector<double> limit_;          // [N]
};

/// Whether constraints hold a part against sliding. A wall that is slid along leaves two directions free.
bool is_held(const solver::Part& rows, std::span<const solver::ParticleConstraint> constraints);

}  // namespace weft::integrator
