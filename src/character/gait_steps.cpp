#include "character/gait_steps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "character/gait_curves.hpp"
#include "character/mannequin_skin.hpp"

namespace weft::character {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

constexpr double kPitchShare = 0.79;  ///< the recorded walker lifts the heels more than a mannequin should
constexpr double kMoreLift = 0.07;    ///< so that toes clear the floor though legs are straighter than the recorded [m]
constexpr double kLag = 0.06;         ///< [m]

constexpr double kRecordedStance = 0.67;  ///< until the toes leave; the recorded walk is slow and stands longer

/// Place, velocity and acceleration at one moment, by central differences.
struct Motion {
  Vec3 place, velocity, acceleration;
};
template <class Path>
Motion motion_of(const Path& path, double t, double h) {
  const Vec3 before = path(t - h), here = path(t), after = path(t + h);
  return {here, (after - before) / (2 * h), (after - 2 * here + before) / (h * h)};
}

/// The quintic from one motion to another over the time `span`, at the share s of it.
Vec3 quintic(const Motion& a, const Motion& b, double span, double s) {
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const double h0 = 1 - 10 * s3 + 15 * s4 - 6 * s5, h1 = s - 6 * s3 + 8 * s4 - 3 * s5,
               h2 = 0.5 * (s2 - 3 * s3 + 3 * s4 - s5), g0 = 1 - h0, g1 = -4 * s3 + 7 * s4 - 3 * s5,
               g2 = 0.5 * (s3 - 2 * s4 + s5);
  return h0 * a.place + h1 * span * a.velocity + h2 * span * span * a.acceleration + g0 * b.place +
         g1 * span * b.velocity + g2 * span * span * b.acceleration;
}

/// By how much the recorded ankle is higher in the air than its own quintic [m].
double recorded_lift(double s) {
  constexpr double span = 1 - kRecordedStance;
  const auto path = [](double phase) { return Vec3(0, 0, walking::ankle_up.at(phase)); };
  static const Motion off = motion_of(path, kRecordedStance, 1e-3), strike = motion_of(path, 1, 1e-3);
  return (path(kRecordedStance + s * span) - quintic(off, strike, span, s)).z();
}

/// Phase of the recording, by the phase since the toes left: the heel rises more slowly than recorded, and therefore
/// earlier, which lets a straighter leg reach; by the next strike phases and rates agree.
double recorded_phase(double since_off) {
  constexpr double rate = 0.7, air = 1 - kStance, rest = 1 - kRecordedStance - rate * air;
  constexpr double bend = 4 - (1 - rate) * air / rest;  // of a cubic and a quartic with rate 1 at the end
  const double s = std::max(since_off, 0.0) / air;
  return kRecordedStance + rate * since_off + rest * s * s * s * (bend + (1 - bend) * s);
}

Vec3 forward_of(double yaw) {
  return {std::sin(yaw), -std::cos(yaw), 0};
}

}  // namespace

double HarmonicCurve::at(double phase) const {
  double sum = mean;
  for (std::size_t k = 0; k < cosine.size(); ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k + 1) * phase;
    sum += cosine[k] * std::cos(angle) + sine[k] * std::sin(angle);
  }
  return sum;
}

FootPath::FootPath(const FootShape& shape, std::vector<Plant> plants, double period)
    : shape_(shape), plants_(std::move(plants)), period_(period) {}

/// As recorded before and after a strike and around the toes' leaving, exactly 0 in between.
double FootPath::pitch(double t, std::size_t plant) const {
  const Plant& here = plants_[plant];
  const double since_strike = (t - here.strike) / period_;
  const double until_off = (here.off - t) / period_;
  const auto recorded = [](double phase) {
    return kPitchShare * kDegree * (walking::foot_pitch.at(phase) - walking::kFlatPitch);
  };
  if (since_strike < 0.16) return here.step_size * recorded(since_strike) * (1 - smooth_ramp(since_strike, 0.08, 0.16));
  if (until_off > kRise || plant + 1 == plants_.size()) return 0;
  return plants_[plant + 1].step_size * recorded(recorded_phase(-until_off)) * smooth_ramp(-until_off, -kRise, -0.16);
}

Vec3 FootPath::rolling_ankle(double t, std::size_t plant) const {
  const double angle = pitch(t, plant);
  const bool on_heel = angle > 0;
  // Around the middle of the heel, which rolls back as the toes rise, or around the ball, which stays.
  const double forward = on_heel ? -shape_.heel_back - shape_.heel_radius * angle : shape_.ball_forward;
  const double up = on_heel ? shape_.heel_radius : shape_.ball_height;
  const double arm_forward = on_heel ? shape_.heel_back : -shape_.ball_forward, arm_up = shape_.ankle_height - up;
  const double c = std::cos(angle), s = std::sin(angle);
  const Plant& here = plants_[plant];
  return Vec3(here.at.x(), here.at.y(), 0) + (forward + c * arm_forward - s * arm_up) * forward_of(here.yaw) +
         (up + s * arm_forward + c * arm_up) * Vec3::UnitZ();
}

Vec3 FootPath::swinging_ankle(double t, std::size_t plant) const {
  const Plant &from = plants_[plant], &to = plants_[plant + 1];
  const double span = to.strike - from.off, s = (t - from.off) / span;
  const Motion off = motion_of([&](double at) { return rolling_ankle(at, plant); }, from.off, 1e-3);
  const Motion strike = motion_of([&](double at) { return rolling_ankle(at, plant + 1); }, to.strike, 1e-3);
  const double bump = 64 * s * s * s * (1 - s) * (1 - s) * (1 - s);
  const double lift = recorded_lift(s) + kMoreLift * bump;
  // Late in the air the quintic is ahead of where a leg can be, and skims the floor.
  const double lag = kLag / 8.9e-4 * std::pow(s, 10) * (1 - s) * (1 - s) * (1 - s);
  const Vec3 detour(to.detour.x(), to.detour.y(), 0);
  return quintic(off, strike, span, s) + bump * detour +
         to.step_size * shape_.leg_length / walking::kLegLength *
             ((lift + 0.2 * lag) * Vec3::UnitZ() - lag * forward_of(to.yaw));
}

FootState FootPath::at(double t) const {
  std::size_t plant = 0;
  while (plant + 1 < plants_.size() && t >= plants_[plant + 1].strike) ++plant;
  const Plant& here = plants_[plant];
  FootState state;
  state.stands = t <= here.off;
  state.pitch = pitch(t, plant);
  if (state.stands) {
    state.ankle = rolling_ankle(t, plant);
    state.yaw = here.yaw;
    state.toes = std::max(-state.pitch, 0.0);
    return state;
  }
  const Plant& next = plants_[plant + 1];
  const double s = (t - here.off) / (next.strike - here.off);
  state.ankle = swinging_ankle(t, plant);
  state.yaw = here.yaw + (next.yaw - here.yaw) * smooth_ramp(s, 0, 1);
  // The toes stretch again early in the air.
  state.toes = std::max(-state.pitch, 0.0) * (1 - smooth_ramp(s, 0.05, 0.6));
  return state;
}

Pace pace_of(double speed, double height) {
  constexpr double walk_ratio = 0.0062;     // m/(steps/min), of the recording
  constexpr double recorded_height = 1.70;  // m; from the walker's legs
  const double length = std::sqrt(walk_ratio * height / recorded_height * 60 * speed);
  return {length, length / speed};
}

}  // namespace weft::character
