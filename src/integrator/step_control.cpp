#include "integrator/step_control.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"

namespace weft::integrator {
namespace {

// The proportional-integral controller PI.4.2 (Söderlind, "Digital filters in adaptive time-stepping", ACM TOMS 29,
// 2003): exponents of this share and of the last one, over the order plus one.
constexpr double kNow = 3.0 / 5, kBefore = -1.0 / 5;

}  // namespace

StepControl::StepControl(Method method, double tolerance, double first)
    : order_plus_one_(method == Method::implicit_euler ? 2 : 3), tolerance_(tolerance), wanted_(first) {}

bool StepControl::accepts(double h, double error) const {
  return meets(error) || (h <= numerics.steps.least && std::isfinite(error));
}

// What was aimed at over what came.
double StepControl::aim_over(double error) const {
  return numerics.steps.aim * tolerance_ / std::max(error, kRoundoff * tolerance_);
}

void StepControl::accepted(double h, double error) {
  const double share = aim_over(error), alone = std::pow(share, 1 / order_plus_one_);
  if (alone > 1 - numerics.steps.kept_change && alone < 1 + numerics.steps.kept_change) {
    wanted_ = h;
  } else {
    const double factor = std::pow(share, kNow / order_plus_one_) * std::pow(last_share_, kBefore / order_plus_one_);
    // Steps are shorter than wanted where that makes them end with the frame: growth goes on from what was wanted.
    const double longest = (after_failure_ ? 1 : numerics.steps.largest_factor) * std::max(h, wanted_);
    wanted_ = std::clamp(std::max(factor, numerics.steps.least_factor) * h, numerics.steps.least, longest);
  }
  last_share_ = share;
  after_failure_ = false;
}

// The elementary controller: the last error has nothing to say of a step that went wrong.
void StepControl::too_inexact(double h, double error) {
  const double factor = std::pow(aim_over(error), 1 / order_plus_one_);
  wanted_ = std::max(h * std::clamp(factor, numerics.steps.least_factor, 1 - numerics.steps.kept_change),
                     numerics.steps.least);
  after_failure_ = true;
}

void StepControl::unsolved(double h) {
  wanted_ = 0.5 * h;
  after_failure_ = true;
}

}  // namespace weft::integrator
