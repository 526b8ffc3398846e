// Where the body is above its feet, without its height: balance.
#pragma once

#include <vector>

#include "character/gait_steps.hpp"

namespace weft::character {

/// Key by key from `first` on.
struct Track {
  int first = 0;
  std::vector<Vec2> place;    ///< of the middle of the hips [m]
  std::vector<double> yaw;    ///< where the body is going, 0 toward -y, + to the left [rad]
  std::vector<double> speed;  ///< mean over a step, of that of even walking
  std::vector<double> phase;  ///< whole where the left heel strikes, and a half more where the right one does

  std::size_t index(int key) const { return static_cast<std::size_t>(key - first); }
  int last() const { return first + static_cast<int>(place.size()) - 1; }
  double yaw_at(int key) const;  ///< the nearest beyond the ends
};

/// The body is an inverted pendulum on the feet: x'' = ω² (x - p), where p is the point that bears the weight (Kajita
/// et al., "The 3D linear inverted pendulum mode", 2001). Its one bounded solution looks as far ahead as back: the mean
/// of p with weights ω/2 exp(-ω |τ|). So the weight goes to the standing leg before the other one is lifted, the body
/// leans into the first step and slows down before it stands.
Track lay_track(const Physique& body, const StepPlan& plan, int first, int last);

}  // namespace weft::character
