// Time steps, and tolerances of the solver.
#pragma once

#include <optional>

#include "physics/integrator/method.hpp"

namespace weft::model {

/// `kMinStep`: smallest Time::step that a scene may give, and smallest time between two keys [s].
/// `kMaxStepsInFrame`: largest number of steps in a frame, so that an int can count them.
inline constexpr double kMinStep = 1e-7, kMaxStepsInFrame = 1e9;

/// Times that differ by less count as equal [s]: the end of a step is a sum of step lengths, which differs by rounding
/// errors from the time that a scene prescribes.
inline constexpr double kSameTime = 1e-9;
/// Whether `t` is later than `prescribed`, by more than rounding.
constexpr bool is_later(double t, double prescribed) {
  return t > prescribed + kSameTime;
}

struct Time {
  double fps = 25;         ///< frames per second; frame k is at the time k / fps
  int preroll_frames = 0;  ///< number of frames before frame 0, with which the run begins
  /// Maximum time step [s]: a frame is divided into the fewest equal steps that are not longer.
  /// Exception: with implicit Euler, a frame in which everything rests may be one step.
  double step = 0.01;
  std::optional<double> tolerance{};  ///< if given, step lengths follow from this allowed local
                                      ///< error of positions in one step [m], not from `step`
  integrator::Method integrator = integrator::Method::implicit_euler;
};

struct Solver {
  double newton_tolerance = 0.4;  ///< error that the solver may leave in a step, relative to the
                                  ///< local truncation error, with a visibility threshold as floor
  int newton_iterations = 60;     ///< maximum number of iterations in one solve (a step may need
                                  ///< several solves); if they do not suffice, the step is rejected
  double linear_tolerance = 0.1;  ///< allowed error of a linear solve, relative to its solution,
                                  ///< both in the energy norm
  int linear_iterations = 1000;   ///< maximum number of conjugate gradient iterations in one linear solve
  int halvings = 8;               ///< how often a step may be rejected and repeated with a shorter
                                  ///< length; at the next rejection, the run ends with an error
};

}  // namespace weft::model
