#include "physics/integrator/sliding.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"

namespace weft::integrator {

bool Sliding::evaluate(const System& system, const StagePoint& at) {
  for (auto* force : {&push_, &friction_}) force->assign(at.v.size(), Vec3::Zero());
  for (auto* of_particles : {&normal_force_, &limit_}) of_particles->assign(at.v.size(), 0);
  return system.contact_forces(at, push_, friction_, normal_force_, limit_);
}

double Sliding::friction_error(const solver::DiagonalBlock& rows, std::span<const Vec3> residual) const {
  Vec3 push = Vec3::Zero(), friction = Vec3::Zero(), missing = Vec3::Zero();
  double normal_force = 0, limit = 0;
  for (auto i = static_cast<std::size_t>(rows.begin); i < static_cast<std::size_t>(rows.end); ++i) {
    push += push_[i];
    friction += friction_[i];
    missing += residual[i];
    normal_force += normal_force_[i];
    limit += limit_[i];
  }
  const double push_norm = push.norm(), friction_norm = friction.norm();
  if (push_norm == 0 || friction_norm == 0 || normal_force <= 0) return 0;
  // Friction that the motion requires, and the largest friction that the normal force allows, both
  // if the residual were zero [N].
  const double along = missing.dot(friction) / friction_norm, required = friction_norm - along;
  const double max_friction = limit * (1 - missing.dot(push) / (push_norm * normal_force));
  return required > numerics.newton.about_to_slide * max_friction ? std::max(std::abs(along), required - max_friction)
                                                                  : 0;
}

bool is_held(const solver::DiagonalBlock& rows, std::span<const solver::ParticleConstraint> constraints) {
  constexpr double kTwoDirections = 1.5;  // the trace of `free` is the number of free directions
  return std::ranges::any_of(constraints, [&](const solver::ParticleConstraint& constraint) {
    return constraint.particle >= rows.begin && constraint.particle < rows.end &&
           constraint.free.trace() < kTwoDirections;
  });
}

}  // namespace weft::integrator
