// Time steps, and tolerances of the solver.
#pragma once

#include <optional>

#include "physics/integrator/method.hpp"

namespace weft::model {

/// `kMinStep`: smallest time step that a scene may give, and smallest time between two keys [s]. `kMaxStepsInFrame`:
/// largest number of steps in a frame, so that an int can count them.
inline constexpr double kMinStep = 1e-7, kMaxStepsInFrame = 1e9;

struct Time {
  double fps = 25;                    ///< frames per second; frame k is at the time k / fps
  int preroll_frames = 0;             ///< frames before frame 0; the run begins with them
  double step = 0.01;                 ///< maximum time step [s]; frames are divided into equal steps, at most this long
  std::optional<double> tolerance{};  ///< replaces `step`: allowed local error of positions in one step [m]
  integrator::Method integrator = integrator::Method::implicit_euler;
};

struct Solver {
  double newton_tolerance = 0.4;  ///< error that the solver may leave, relative to the local truncation error
  int newton_iterations = 60;     ///< maximum per step; a step that needs more is rejected
  double linear_tolerance = 0.1;  ///< allowed error of a linear solve, relative to its solution, in the energy norm
  int linear_iterations = 1000;   ///< maximum number of conjugate gradient iterations in one linear solve
  int halvings = 8;               ///< how often a rejected step is repeated shorter before the run ends with an error
};

}  // namespace weft::model
