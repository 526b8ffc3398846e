#include "physics/collision/response/carried_starts.hpp"

#include <algorithm>

namespace weft::collision {

void CarriedStarts::begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                               std::span<const RigidMotion> motions) {
  x_t0_ = x_t0;
  x_t1_ = x_t1;
  motions_.assign(motions.begin(), motions.end());
  any_rotates_ = std::ranges::any_of(motions_, [](const RigidMotion& motion) { return motion.rotates(); });
  starts_.resize(motions_.size());
  for (std::vector<Vec3>& starts : starts_) starts.clear();
}

void CarriedStarts::compute_all() const {
  for (std::size_t body = 0; any_rotates_ && body < motions_.size(); ++body)
    if (motions_[body].rotates()) by(body);
}

std::span<const Vec3> CarriedStarts::by(std::size_t body) const {
  std::vector<Vec3>& starts = starts_[body];
  if (!starts.empty()) return starts;
  const RigidMotion& motion = motions_[body];
  starts.assign(x_t0_.begin(), x_t0_.end());
  for (Index v = 0; v < first_obstacle_; ++v) starts[v] = motion.rotation * x_t0_[v] + motion.translation;
  for (std::size_t v = static_cast<std::size_t>(first_obstacle_); v < starts.size(); ++v)
    if (body_of_[v] == body) starts[v] = x_t1_[v];
  return starts;
}

}  // namespace weft::collision
