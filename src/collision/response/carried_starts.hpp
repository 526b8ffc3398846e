// A step as who stands on an obstacle sees it: where everything would have started if that had carried it along.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "collision/response/certificate.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// What a body that keeps its shape does in a step: x at the start is turn · x + shift at the end.
struct RigidMotion {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();  ///< [m]
  bool turns() const { return turn != Mat3::Identity(); }
  bool moves() const { return turns() || shift != Vec3::Zero(); }
};

/// An obstacle that turns moves on arcs, while certificates speak of straight ways (see `separates`). Seen from the
/// obstacle itself it stands still: from starts that it has carried along to its place at the end, the ways of cloth
/// past it are straight again, and a plane fixed to the obstacle can separate them for the whole step. Where cloth is
/// carried along it stays exactly as far from the obstacle as it was, so one obstacle alone never leaves it no room.
class CarriedStarts {
 public:
  CarriedStarts() = default;
  /// Vertices from `first_obstacle` on are those of obstacles; `body_of`: body of each vertex.
  CarriedStarts(Index first_obstacle, std::vector<std::size_t> body_of)
      : first_obstacle_(first_obstacle), body_of_(std::move(body_of)) {}

  /// A step from x_t0, with obstacles at its end in x_t1 [m]; both must outlive it. `motions`: one for each body, those
  /// of cloths are not looked at; none: nothing is carried.
  void begin_step(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, std::span<const RigidMotion> motions);

  /// Whether a body moves as a rigid one.
  bool carries(std::size_t body) const { return body < motions_.size() && motions_[body].moves(); }
  /// Starts carried along by such a body, with its own vertices where they end [m].
  std::span<const Vec3> by(std::size_t body) const;
  /// Makes all that of() can ask for, so that threads may ask at the same time.
  void make() const;

  /// The starts to look at a pair from: those that its obstacle has carried where that turns, else `x_t0`, which tells
  /// the same.
  std::span<const Vec3> of(const CornerPair& pair, std::span<const Vec3> x_t0) const {
    if (!any_turns_ || !has_obstacle(pair)) return x_t0;
    const std::size_t body = obstacle_of(pair);
    return motions_[body].turns() ? by(body) : x_t0;
  }

  bool has_obstacle(const CornerPair& pair) const {
    return pair.b[0] >= first_obstacle_ && pair.a[0] < first_obstacle_;
  }
  std::size_t obstacle_of(const CornerPair& pair) const { return body_of_[pair.b[0]]; }

 private:
  Index first_obstacle_ = 0;
  std::vector<std::size_t> body_of_;
  std::vector<RigidMotion> motions_;
  bool any_turns_ = false;
  std::span<const Vec3> x_t0_, x_t1_;
  mutable std::vector<std::vector<Vec3>> starts_;  // by body, made when first asked for
};

}  // namespace weft::collision
