// Step sizes from estimates of the local error.
#pragma once

#include <cmath>

#include "core/archive.hpp"
#include "core/numerics.hpp"
#include "physics/integrator/stepper.hpp"

namespace weft::integrator {

/// Keeps the local error of each step near a tolerance: the error per step, not per second. An impact changes the
/// velocity by Δv at once, so that a step of length h has an error of about h Δv; a bound of the error per second would
/// reduce h to 0. In smooth motion, a method of order p takes step sizes proportional to
/// tolerance^(1/(p+1)), and the final error is proportional to tolerance^(p/(p+1)); the latter
/// exponent is 1/2 for Euler, and 2/3 for midpoint and BDF2.
class StepControl {
 public:
  /// `tolerance`: bound of the local error [m]; `first`: length of the first step [s].
  StepControl(Method method, double tolerance, double first);

  /// Whether a step over h [s] with this error [m] is accepted. If h is at most
  /// `Numerics::Steps::min_step`, any finite error is accepted.
  bool accepts(double h, double error) const;
  /// Whether this error [m] is within the tolerance.
  bool meets_tolerance(double error) const { return error <= tolerance_; }

  /// Length of the next step [s]. The three functions below update it after a step over h [s] that
  /// was accepted, rejected for its error [m], or not solved.
  double next_step_size() const { return wanted_; }
  void record_accepted_step(double h, double error);
  void record_rejected_step(double h, double error);
  void record_unsolved_step(double h);

  /// Saves or restores the state after an accepted step. Throws std::runtime_error if a restored value is impossible.
  template <class Archive>
  void serialize(Archive& archive) {
    serialize_values(archive, wanted_, last_ratio_);
    // After steps that were not solved, `wanted_` may be below `min_step`.
    if constexpr (Archive::kReads)
      require(wanted_ >= 0.1 * numerics.steps.min_step && std::isfinite(wanted_) && std::isfinite(last_ratio_),
              "a step length");
  }

 private:
  double target_to_error_ratio(double error) const;

  double order_plus_one_, tolerance_, wanted_;
  double last_ratio_ = 1;       // target error / error, of the last accepted step
  bool after_failure_ = false;  // the last step was rejected or not solved: steps must not grow yet
};

}  // namespace weft::integrator
