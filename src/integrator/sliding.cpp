#include "integrator/sliding.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"

namespace weft::integrator {
namespace {}  // namespace

bool Sliding::evaluate(const System& system, const StagePoint& at) {
  for (auto* force : {&push_, &friction_}) force->assign(at.v.size(), Vec3::Zero());
  limit_.assign(at.v.size(), 0);
  return system.contact_forces(at, push_, friction_, limit_);
}

double Sliding::wrong_friction(const solver::Part& rows, std::span<const Vec3> residual) const {
  Vec3 push = Vec3::Zero(), friction = Vec3::Zero(), missing = Vec3::Zero();
  double load = 0, limit = 0;
  for (auto i = static_cast<std::size_t>(rows.begin); i < static_cast<std::size_t>(rows.end); ++i) {
    push += push_[i];
    friction += friction_[i];
    missing += residual[i];
    load += push_[i].norm();
    limit += limit_[i];
  }
  const double pushed = push.norm(), rubbed = friction.norm();
  if (pushed == 0 || rubbed == 0) return 0;
  // Friction that the motion takes, and the most that its load allows.
  const double along = missing.dot(friction) / rubbed, taken = rubbed - along;
  const double most = limit * (1 - missing.dot(push) / (pushed * load));
  return taken > numerics.newton.about_to_slide * most ? std::max(std::abs(along), taken - most) : 0;
}

bool is_held(const solver::Part& rows, std::span<const solver::ParticleConstraint> constraints) {
  constexpr double kTwoDirections = 1.5;
  return std::ranges::any_of(constraints, [&](const solver::ParticleConstraint& constraint) {
    return constraint.particle >= rows.begin && constraint.particle < rows.end &&
           constraint.free.trace() < kTwoDirections;
  });
}

}  // namespace weft::integrator
