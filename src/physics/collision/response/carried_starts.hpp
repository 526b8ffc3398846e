// Start positions of a step, carried by a moving obstacle: where the particles would be at the end
// of the step if they moved rigidly with the obstacle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/response/separating_plane.hpp"

namespace weft::collision {

/// Motion of a body that keeps its shape over one step. A point moves from x to rotation · x + translation.
struct RigidMotion {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  ///< [m]
  bool rotates() const { return rotation != Mat3::Identity(); }
  bool moves() const { return rotates() || translation != Vec3::Zero(); }
};

/// The vertices of an obstacle that turns move on arcs, but separating planes are found for straight trajectories (see
/// `separates` in separating_plane.hpp). In its own frame, the obstacle rests. This class therefore applies the motion
/// of the obstacle to the start positions of all particles. The results are the carried starts. On the straight
/// trajectory from the carried starts to the end of the step, the obstacle stays at its end, so that a plane fixed to
/// it can separate a pair for the whole step. A particle that ends at its carried start has moved rigidly with the
/// obstacle, so it does not meet this obstacle.
class CarriedStarts {
 public:
  CarriedStarts() = default;
  /// Vertices from `first_obstacle` on belong to obstacles. `body_of`: body of each vertex; must outlive it.
  CarriedStarts(Index first_obstacle, std::span<const std::size_t> body_of)
      : first_obstacle_(first_obstacle), body_of_(body_of) {}

  /// Begins a step from x_t0 to x_t1 [m]; of x_t1, only the ends of the obstacles are used. Both must outlive the step.
  /// `motions`: one for each body; empty: nothing is carried.
  void begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const RigidMotion> motions);

  /// Whether a body moves in this step without changing its shape.
  bool carries(std::size_t body) const { return body < motions_.size() && motions_[body].moves(); }
  /// Starts of the particles, carried by this body [m]. Vertices of the body itself are at their end, those of other
  /// obstacles at their start.
  std::span<const Vec3> by(std::size_t body) const;
  /// Computes all starts that of() can return. Threads may then call of() at the same time.
  void compute_all() const;

  /// Start positions for testing a pair: carried by the obstacle of the pair if this obstacle turns, else `x_t0`.
  std::span<const Vec3> of(const CornerPair& pair, std::span<const Vec3> x_t0) const {
    if (!any_rotates_ || !has_obstacle(pair)) return x_t0;
    const std::size_t body = obstacle_of(pair);
    return motions_[body].rotates() ? by(body) : x_t0;
  }

  bool has_obstacle(const CornerPair& pair) const {
    return pair.b[0] >= first_obstacle_ && pair.a[0] < first_obstacle_;
  }
  std::size_t obstacle_of(const CornerPair& pair) const { return body_of_[pair.b[0]]; }

 private:
  Index first_obstacle_ = 0;
  std::span<const std::size_t> body_of_;
  std::vector<RigidMotion> motions_;
  bool any_rotates_ = false;
  std::span<const Vec3> x_t0_, x_t1_;
  mutable std::vector<std::vector<Vec3>> starts_;  // by body, computed on first use
};

}  // namespace weft::collision
