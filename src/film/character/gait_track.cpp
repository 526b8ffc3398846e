#include "film/character/gait_track.hpp"

#include <algorithm>
#include <cmath>

#include "film/character/mannequin_skin.hpp"

namespace weft::character {
namespace {

constexpr double kGravity = 9.81;          // m/s²
constexpr double kMassHeight = 0.55;       // height of the centre of mass / body height
constexpr double kForesightStrides = 0.7;  // footholds farther in the past or future have no effect [strides]
// Offsets of bearing_point() for a body height of 1.75 m [m]: backward at the strike (< 0: forward), forward at
// toe-off.
constexpr double kRollBack = -0.01;
constexpr double kRollForward = 0.175;

/// Centred moving average over `width` keys (an even number). The keys at both ends have half weight.
template <class Value>
std::vector<Value> mean_around(const std::vector<Value>& values, int width) {
  std::vector<Value> means;
  const int n = static_cast<int>(values.size());
  for (int k = 0; k < n; ++k) {
    Value sum = values[0] * 0;
    for (int d = -width / 2; d <= width / 2; ++d) {
      const double fraction = std::abs(d) == width / 2 ? 0.5 : 1;
      sum += fraction / width * values[std::clamp(k + d, 0, n - 1)];
    }
    means.push_back(sum);
  }
  return means;
}

/// Mean of p over past and future with the weights exp(-ω |τ|), τ being the time difference. The weights fade to 0 at
/// `half_width` keys, so that a standing body does not move. `omega`: ω [1/s].
std::vector<Vec2> balance(const std::vector<Vec2>& p, double omega, double key_time, int half_width) {
  std::vector<double> weights;  // by distance in keys
  double sum = 0;
  for (int d = 0; d < half_width; ++d) {
    weights.push_back(std::exp(-omega * d * key_time) * (1 - smooth_ramp(d, 0.5 * half_width, half_width)));
    sum += d == 0 ? weights[0] : 2 * weights.back();
  }
  std::vector<Vec2> means;
  const int n = static_cast<int>(p.size());
  for (int k = 0; k < n; ++k) {
    Vec2 mean = Vec2::Zero();
    for (int d = 1 - half_width; d < half_width; ++d) {
      mean += weights[std::abs(d)] / sum * p[std::clamp(k + d, 0, n - 1)];
    }
    means.push_back(mean);
  }
  return means;
}

/// Fraction of the body weight on a foot, 0 to 1. The sum over both feet is not yet 1.
double weight_fraction(const StepPlan& plan, const Foothold& foothold, int key) {
  const double on = std::clamp(plan.strides_since_strike(foothold, key) / kOverlap, 0.0, 1.0);
  const double off = std::clamp(plan.until_off(foothold, key) / kOverlap, 0.0, 1.0);
  return std::min(on, off);
}

/// The point below a foot that bears the weight [m]. It moves forward during stance.
Vec2 bearing_point(const Physique& body, const StepPlan& plan, const Foothold& foothold, double next_size, int key) {
  const double cm = body.height / 175;
  const double back = kRollBack * (1 - smooth_ramp(plan.strides_since_strike(foothold, key), 0, 0.3)) * foothold.size;
  const double front = kRollForward * smooth_ramp(-plan.until_off(foothold, key), -0.4, 0) * std::min(next_size, 1.0);
  const Vec2 forward(std::sin(foothold.yaw), -std::cos(foothold.yaw));
  return foothold.at + (body.stance_forward + 100 * cm * (front - back)) * forward;
}

}  // namespace

double Track::yaw_at(int key) const {
  return yaw[index(std::clamp(key, first, last()))];
}

Track balance_body(const Physique& body, const StepPlan& plan, int first, int last) {
  Track track;
  track.first = first;
  std::vector<double> phase;
  for (int key = first; key <= last; ++key) {
    Vec2 point = Vec2::Zero();
    double yaw = 0, sum = 0;
    for (int side = 0; side < 2; ++side) {
      const auto& footholds = plan.footholds[side];
      const std::size_t number = plan.foothold_at(side, key);
      const double fraction = weight_fraction(plan, footholds[number], key);
      const double next_size = number + 1 < footholds.size() ? footholds[number + 1].size : 0;
      point += fraction * bearing_point(body, plan, footholds[number], next_size, key);
      yaw += fraction * footholds[number].yaw;
      sum += fraction;
    }
    track.place.push_back(point / sum);
    track.yaw.push_back(yaw / sum);
    // Beyond the first and the last strike, the phase continues at the same rate.
    const auto& strikes = plan.strikes;
    std::size_t next = 1;
    while (next + 1 < strikes.size() && key >= strikes[next].key) ++next;
    const double between =
        static_cast<double>(key - strikes[next - 1].key) / (strikes[next].key - strikes[next - 1].key);
    phase.push_back(0.5 * (static_cast<double>(next - 1) + between + strikes[0].side));
  }
  const double omega = std::sqrt(kGravity / (kMassHeight * body.height));
  track.place = balance(track.place, omega, plan.key_time, static_cast<int>(kForesightStrides * plan.period()));
  track.yaw = mean_around(mean_around(track.yaw, plan.step_keys), plan.step_keys);
  track.phase = std::move(phase);
  std::vector<double> speed(track.place.size(), 0);
  for (std::size_t k = 1; k + 1 < speed.size(); ++k)
    speed[k] = (track.place[k + 1] - track.place[k - 1]).norm() / (2 * plan.key_time * plan.speed);
  track.speed = mean_around(mean_around(speed, plan.step_keys), plan.step_keys / 2 / 2 * 2);
  return track;
}

}  // namespace weft::character
