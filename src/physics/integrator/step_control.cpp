#include "physics/integrator/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"

namespace weft::integrator {
namespace {

// The proportional-integral controller PI.4.2 (Söderlind, "Digital filters in adaptive time-stepping", ACM TOMS 29,
// 2003): exponents of the ratio target error / error, for this step and for the accepted step before
// it. record_accepted_step() divides them by the order plus one.
constexpr double kExponentNow = 3.0 / 5, kExponentBefore = -1.0 / 5;

}  // namespace

StepControl::StepControl(Method method, double tolerance, double first)
    : order_plus_one_(method == Method::implicit_euler ? 2 : 3), tolerance_(tolerance), wanted_(first) {}

bool StepControl::accepts(double h, double error) const {
  return meets_tolerance(error) || (h <= numerics.steps.min_step && std::isfinite(error));
}

// Ratio of the target error to this error; finite even if the error is 0.
double StepControl::target_to_error_ratio(double error) const {
  return numerics.steps.target_error_ratio * tolerance_ / std::max(error, kRoundoff * tolerance_);
}

void StepControl::record_accepted_step(double h, double error) {
  const double ratio = target_to_error_ratio(error);
  const double factor =
      std::pow(ratio, kExponentNow / order_plus_one_) * std::pow(last_ratio_, kExponentBefore / order_plus_one_);
  // A step may be shorter than `wanted_`, to end with its frame; then the next one may still grow
  // from `wanted_`.
  const double max_step = (after_failure_ ? 1 : numerics.steps.largest_factor) * std::max(h, wanted_);
  // After unsolved steps, `max_step` may be below `min_step`; then `max_step` is the bound.
  wanted_ = std::min(std::max(std::max(factor, numerics.steps.least_factor) * h, numerics.steps.min_step), max_step);
  last_ratio_ = ratio;
  after_failure_ = false;
}

// The elementary controller: it does not use `last_ratio_`.
void StepControl::record_rejected_step(double h, double error) {
  const double factor = std::pow(target_to_error_ratio(error), 1 / order_plus_one_);
  wanted_ = std::max(h * std::clamp(factor, numerics.steps.least_factor, 1.0), numerics.steps.min_step);
  after_failure_ = true;
}

void StepControl::record_unsolved_step(double h) {
  wanted_ = 0.5 * h;
  after_failure_ = true;
}

}  // namespace weft::integrator
