// Horizontal motion of the body above its feet: balance.
#pragma once

#include <vector>

#include "film/character/gait_steps.hpp"

namespace weft::character {

/// Horizontal position and heading of the body. Each list has one value per key, from key `first` on.
struct Track {
  int first = 0;
  std::vector<Vec2> place;    ///< middle of the hips [m]
  std::vector<double> yaw;    ///< heading of the body, 0 toward -y, + to the left [rad]
  std::vector<double> speed;  ///< smoothed over 1.5 steps, relative to the steady walking speed
  std::vector<double> phase;  ///< integer at a strike of the left heel, integer + 0.5 at one of the right

  std::size_t index(int key) const { return static_cast<std::size_t>(key - first); }
  int last() const { return first + static_cast<int>(place.size()) - 1; }
  double yaw_at(int key) const;  ///< beyond the ends, the value at the nearer end
};

/// Computes the keys `first` to `last` of the body's motion. Treats the body as an inverted pendulum on the feet:
/// x'' = ω² (x - p), where x is the middle of the hips, p the point that bears the weight, and ω = √(g / height of the
/// centre of mass) (Kajita et al., "The 3D linear inverted pendulum mode", 2001). The only bounded solution x is the
/// mean of p over past and future, with the weight ω/2 exp(-ω |τ|) at the time difference τ. The weight therefore moves
/// to the stance leg before the other foot lifts off, and the body moves forward before the first step and slows down
/// before it stops.
Track balance_body(const Physique& body, const StepPlan& plan, int first, int last);

}  // namespace weft::character
