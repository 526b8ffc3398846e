// Lengths of steps from estimates of their local errors.
#pragma once

#include <cmath>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "integrator/stepper.hpp"

namespace weft::integrator {

/// Keeps the local error of each step at a tolerance. Error per step, not per second: what a velocity that jumps in an
/// impact leaves in one step is h Δv at best, which an error per second would chase down to h = 0. So the steps go as
/// tolerance^(1/(p+1)) with a method of order p, and the error in the end as tolerance^(p/(p+1)): 1/2 for Euler, 2/3
/// for midpoint and BDF2.
///
/// It remembers the last error and the length it wants: both are part of the state of a simulation.
class StepControl {
 public:
  /// The tolerance and the estimates are lengths [m]; `first` is the length of the first step [s].
  StepControl(Method method, double tolerance, double first);

  /// Whether a step over h with this error may stand. Steps of the least length do in any case.
  bool accepts(double h, double error) const;
  bool meets(double error) const { return error <= tolerance_; }

  /// How long the next step should be [s]: after one over h that was accepted, was too inexact, or was not solved.
  double wanted() const { return wanted_; }
  void accepted(double h, double error);
  void too_inexact(double h, double error);
  void unsolved(double h);

  /// What it remembers after an accepted step. Throws std::runtime_error where that cannot be.
  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, wanted_, last_share_);
    // Half of the shortest step may be wanted after it failed.
    if constexpr (Archive::kReads)
      require(wanted_ >= 0.1 * numerics.steps.least && std::isfinite(wanted_) && std::isfinite(last_share_),
              "a step length");
  }

 private:
  double aim_over(double error) const;

  double order_plus_one_, tolerance_, wanted_;
  double last_share_ = 1;       // of the last accepted step: what was aimed at, over its error
  bool after_failure_ = false;  // the step before was done again: do not grow at once
};

}  // namespace weft::integrator
