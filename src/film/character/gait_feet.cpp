#include "film/character/gait_feet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "film/character/gait_curves.hpp"
#include "film/character/mannequin_skin.hpp"

namespace weft::character {
namespace {

constexpr double kStandingKnee = 6;   ///< knee bend of a standing leg [degrees]; a smaller bend looks stiff
constexpr double kPitchRatio = 0.79;  ///< factor on the recorded foot pitch, which is too large
/// A leg determines the height of the pelvis until this time before the strike of the other leg [strides].
constexpr double kReleaseFraction = 0.17;
/// A leg determines the height of the pelvis from this time after its strike on [strides].
constexpr double kTakeoverFraction = 0.13;
constexpr double kLateKneeRatio = 0.75;    ///< factor on the knee curve before toe-off
constexpr double kHeelRiseLength = 0.002;  ///< length that smooths the start of the heel rise [m]
/// Knee bend added in swing [degrees], because kLateKneeRatio reduces the bend at toe-off.
constexpr double kSwingKneeShift = 13;
constexpr double kToesFlat = 22, kToesRound = 16, kToePitchRatio = 0.75;  ///< see toe_pitch() [degrees, degrees, 1]
constexpr double kMaxToePitch = 80;      ///< maximum pitch of a foot on its toes [degrees]
constexpr double kInPlaceKneeLift = 32;  ///< additional knee bend in a step in place [degrees]
constexpr double kToeClearRatio = 0.36;  ///< peak of the pitch added in swing / (pitch rate at toe-off × swing time)

/// A value with its first and second derivative with respect to the key number.
template <class Value>
struct Derivatives {
  Value value, first_derivative, second_derivative;
};
template <class Function>
auto find_derivatives(const Function& f, int key) {
  const auto before = f(key - 1), here = f(key), after = f(key + 1);
  using Value = std::decay_t<decltype(here)>;
  return Derivatives<Value>{here, Value((after - before) / 2), Value(after - 2 * here + before)};
}

/// Quintic Hermite interpolation between a and b, which are `span` keys apart, at the fraction s of the span.
template <class Value>
Value interpolate_quintic(const Derivatives<Value>& a, const Derivatives<Value>& b, double span, double s) {
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  const double h0 = 1 - 10 * s3 + 15 * s4 - 6 * s5, h1 = s - 6 * s3 + 8 * s4 - 3 * s5,
               h2 = 0.5 * (s2 - 3 * s3 + 3 * s4 - s5), g0 = 1 - h0, g1 = -4 * s3 + 7 * s4 - 3 * s5,
               g2 = 0.5 * (s3 - 2 * s4 + s5);
  return h0 * a.value + h1 * span * a.first_derivative + h2 * span * span * a.second_derivative + g0 * b.value +
         g1 * span * b.first_derivative + g2 * span * span * b.second_derivative;
}

/// 0 at both ends, 1 in the middle; twice continuously differentiable.
double bump(double s) {
  return 64 * s * s * s * (1 - s) * (1 - s) * (1 - s);
}

/// Like bump(), with an earlier maximum.
double early_bump(double s) {
  return 119.2 * s * s * s * (1 - s) * (1 - s) * (1 - s) * (1 - s);
}

/// Like bump(), with its maximum at s = 0.6 and a non-zero second derivative at s = 1. The steep decrease at the end
/// prevents a foot from touching the floor before its foothold.
double late_bump(double s) {
  return 28.9 * s * s * s * (1 - s) * (1 - s);
}

/// Knee bend in swing that is added to the quintic interpolation between toe-off and strike [degrees]. `s`: fraction of
/// the swing.
double swing_knee_offset(double s) {
  constexpr int fine = 1000;  // samples per stride
  const auto curve = [](int at) { return walking::knee.at(static_cast<double>(at) / fine); };
  static const auto off = find_derivatives(curve, static_cast<int>(kStance * fine));
  static const Derivatives<double> strike{curve(fine), 0, 0};
  return walking::knee.at(kStance + s * kSwing) - interpolate_quintic(off, strike, kSwing * fine, s) +
         kSwingKneeShift * early_bump(s);
}

Vec3 forward_direction(double yaw) {
  return {std::sin(yaw), -std::cos(yaw), 0};
}
Vec3 left_direction(double yaw) {
  return {std::cos(yaw), std::sin(yaw), 0};
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

Feet::Feet(const Physique& body, const StepPlan& plan, const Track& track, const HipOffsets& hips)
    : body_(body), plan_(plan), track_(track), hips_(hips) {
  find_heights();
}

/// Size of the step that leaves a foothold; 0 for the last foothold.
double Feet::next_size(int side, std::size_t number) const {
  return number + 1 < plan_.footholds[side].size() ? foothold(side, number + 1).size : 0;
}

Vec3 Feet::hip(int side, int key) const {
  const Vec2& place = track_.place[track_.index(key)];
  return Vec3(place.x(), place.y(), heights_.empty() ? 0 : pelvis_height(key)) + hips_[track_.index(key)][side];
}

/// Knee bend of a stance leg [degrees]: kStandingKnee plus the difference between walking::knee and kStandingKnee. This
/// difference has two parts: the part after the strike is scaled by the size of the step to this foothold, the part
/// before toe-off by the size of the next step and by kLateKneeRatio. Sizes above 1 count as 1.
double Feet::knee(int side, std::size_t number, int key) const {
  const Foothold& here = foothold(side, number);
  const double since = plan_.strides_since_strike(here, key), until = plan_.until_off(here, key);
  const double early = std::min(here.size, 1.0) * (1 - smooth_ramp(since, 0.2, 0.35));
  const double late = kLateKneeRatio * std::min(next_size(side, number), 1.0) * smooth_ramp(kStance - until, 0.2, 0.35);
  double bend = kStandingKnee;
  if (early > 0) bend += early * (walking::knee.at(since) - kStandingKnee);
  if (late > 0) bend += late * (walking::knee.at(kStance - until) - kStandingKnee);
  return bend;
}

/// Distance from hip to ankle [m] at a knee bend [degrees], by the law of cosines.
double Feet::leg_extent(double knee) const {
  const double a = body_.thigh, b = body_.shin;
  return std::sqrt(a * a + b * b + 2 * a * b * std::cos(knee * kDegree));
}

/// Foot pitch after a strike [rad]: the recorded pitch, scaled by kPitchRatio and the size of the step. It fades to
/// exactly 0 within 0.12 strides.
double Feet::strike_pitch(const Foothold& foothold, int key) const {
  const double since = plan_.strides_since_strike(foothold, key);
  if (since > 0.12) return 0;
  const double recorded = kPitchRatio * kDegree * (walking::foot_pitch.at(since) - walking::kFlatPitch);
  return foothold.size * recorded * (1 - smooth_ramp(since, 0.03, 0.12));
}

/// Pitch of the toes relative to the floor [rad]. It is 0 until the foot is pitched down by kToesFlat. From there on,
/// the toes roll over their tips by kToePitchRatio times the further pitch. A parabola over the angle kToesRound
/// smooths the transition.
double Feet::toe_pitch(double pitch) {
  const double beyond = -pitch - kToesFlat * kDegree, round = kToesRound * kDegree;
  if (beyond <= 0) return 0;
  return -kToePitchRatio * (beyond < round ? beyond * beyond / (2 * round) : beyond - round / 2);
}

/// Position of the ankle of a rolling foot [m]. If `pitch` > 0, the foot rolls over its round heel, so that the contact
/// point moves back. Otherwise, it bends at the ball and rolls over the toe tips.
Vec3 Feet::rolling_ankle(const Foothold& foothold, double pitch) const {
  const auto rotate = [](double forward, double up, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Vec2(c * forward - s * up, s * forward + c * up);
  };
  Vec2 ankle;  // forward and up
  if (pitch > 0) {
    ankle = Vec2(-body_.heel_back - body_.heel_radius * pitch, body_.heel_radius) +
            rotate(body_.heel_back, body_.ankle_height - body_.heel_radius, pitch);
  } else {
    const double toes = toe_pitch(pitch);
    ankle = Vec2(body_.ball_forward + body_.toe_length - body_.toe_radius * toes, body_.toe_radius) +
            rotate(-body_.toe_length, body_.ball_height - body_.toe_radius, toes) +
            rotate(-body_.ball_forward, body_.ankle_height - body_.ball_height, pitch);
  }
  return Vec3(foothold.at.x(), foothold.at.y(), 0) + ankle.x() * forward_direction(foothold.foot_yaw) +
         ankle.y() * Vec3::UnitZ();
}

/// Foot pitch in stance [rad]: early in stance, strike_pitch(); late in stance, the pitch at which the raised heel
/// gives the knee the bend knee().
double Feet::standing_pitch(int side, std::size_t number, int key) const {
  const Foothold& here = foothold(side, number);
  const double fraction = smooth_ramp(kStance - plan_.until_off(here, key), 0.24, 0.36);
  if (fraction == 0) return strike_pitch(here, key);
  const Vec3 from = hip(side, key);
  const double flat = (from - rolling_ankle(here, 0)).norm(), excess = flat - leg_extent(knee(side, number, key));
  const double wanted = flat - 0.5 * (excess + std::sqrt(excess * excess + kHeelRiseLength * kHeelRiseLength));
  // Bisection works because the distance from ankle to hip decreases monotonically as the heel rises.
  double low = -kMaxToePitch * kDegree, high = 0;
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (low + high);
    ((from - rolling_ankle(here, middle)).norm() < wanted ? low : high) = middle;
  }
  return fraction * 0.5 * (low + high) + strike_pitch(here, key);
}

FootState Feet::stance_state(int side, std::size_t number, int key) const {
  const Foothold& here = foothold(side, number);
  FootState state;
  state.pitch = standing_pitch(side, number, key);
  state.ankle = rolling_ankle(here, state.pitch);
  state.yaw = here.yaw;
  state.toes = std::max(toe_pitch(state.pitch) - state.pitch, 0.0);
  return state;
}

FootState Feet::swing_state(int side, std::size_t number, int key) const {
  const Foothold &from = foothold(side, number), &to = foothold(side, number + 1);
  const double span = to.strike - from.off, s = (key - from.off) / span;
  // Interpolated values: bend of the knee [degrees], forward angle of the leg from the vertical [rad], offset of the
  // ankle from the hip to the left [m], pitch of the foot [rad].
  using Values = Eigen::Vector4d;
  const auto values_of = [&](std::size_t which) {
    return [this, side, which](int at) {
      const FootState foot = stance_state(side, which, at);
      const Vec3 leg = foot.ankle - hip(side, at);
      const double yaw = track_.yaw_at(at), forward = leg.dot(forward_direction(yaw)), d = leg.norm();
      const double a = body_.thigh, b = body_.shin;
      const double bend = std::acos(std::clamp((d * d - a * a - b * b) / (2 * a * b), -1.0, 1.0)) / kDegree;
      return Values(bend, std::atan2(forward, -leg.z()), leg.dot(left_direction(yaw)), foot.pitch);
    };
  };
  Derivatives<Values> strike = find_derivatives(values_of(number + 1), to.strike);
  // The velocity and acceleration of the knee at the strike are 0. They need not match those after the strike, because
  // the heel lands abruptly.
  strike.first_derivative[0] = strike.second_derivative[0] = 0;
  Derivatives<Values> off = find_derivatives(values_of(number), from.off);
  off.second_derivative[3] = 0;
  Values now = interpolate_quintic(off, strike, span, s);
  const double size = std::min(to.size, 1.0);
  now[0] += size * swing_knee_offset(s) + kInPlaceKneeLift * (1 - size) * late_bump(s);
  now[2] += (side == 0 ? 1 : -1) * to.aside * bump(s);
  now[3] -= kToeClearRatio * off.first_derivative[3] * span * early_bump(s);
  const double d = leg_extent(now[0]), down = std::sqrt(d * d - now[2] * now[2]), yaw = track_.yaw_at(key);
  FootState state;
  state.ankle = hip(side, key) + down * std::sin(now[1]) * forward_direction(yaw) + now[2] * left_direction(yaw) -
                down * std::cos(now[1]) * Vec3::UnitZ();
  state.yaw = from.yaw + (to.yaw - from.yaw) * smooth_ramp(s, 0, 1);
  state.pitch = now[3];
  // The toes straighten early in swing.
  state.toes = std::max(toe_pitch(state.pitch) - state.pitch, 0.0) * (1 - smooth_ramp(s, 0.05, 0.6));
  return state;
}

FootState Feet::at(int side, int key) const {
  const std::size_t number = plan_.foothold_at(side, key);
  return key <= foothold(side, number).off ? stance_state(side, number, key) : swing_state(side, number, key);
}

/// Height of the pelvis above the floor [m] at which the knee of a stance leg has the bend knee().
double Feet::height_above(int side, std::size_t number, int key) const {
  const Foothold& here = foothold(side, number);
  const Vec3 leg = hip(side, key) - rolling_ankle(here, strike_pitch(here, key));
  const double d = leg_extent(knee(side, number, key));
  // heights_ is not computed yet. hip() therefore assumes that Joint::hips is at height 0.
  return std::sqrt(d * d - leg.head<2>().squaredNorm()) - leg.z();
}

/// Computes the heights of the pelvis. While no leg determines the height, it is interpolated and then corrected, such
/// that the knee of the leading leg has the bend knee() at its strike.
void Feet::find_heights() {
  struct Support {
    int side;
    std::size_t number;
    int strike, begin, end;
  };
  const int before = static_cast<int>(std::round(kReleaseFraction * plan_.period())),
            after = static_cast<int>(std::round(kTakeoverFraction * plan_.period()));
  std::vector<Support> supports{{1 - plan_.strikes[0].side, 0, -kFarKey, -kFarKey, 0}};
  std::array<std::size_t, 2> numbers{0, 0};
  for (const auto& strike : plan_.strikes) {
    supports.back().end = strike.key - before;
    supports.push_back({strike.side, ++numbers[strike.side], strike.key, strike.key + after, kFarKey});
  }
  std::vector<double> heights;
  std::size_t now = 0;
  for (int key = track_.first; key <= track_.last(); ++key) {
    while (now + 1 < supports.size() && key >= supports[now + 1].begin) ++now;
    const auto above = [&](const Support& support) {
      return [this, &support](int at) { return height_above(support.side, support.number, at); };
    };
    const Support& support = supports[now];
    if (key <= support.end) {
      heights.push_back(above(support)(key));
      continue;
    }
    const Support& next = supports[now + 1];
    const double span = next.begin - support.end;
    const auto between = [&](int at) {
      return interpolate_quintic(find_derivatives(above(support), support.end),
                                 find_derivatives(above(next), next.begin), span, (at - support.end) / span);
    };
    const double correction = above(next)(next.strike) - between(next.strike);
    heights.push_back(between(key) +
                      correction * bump((key - support.end) / span) / bump((next.strike - support.end) / span));
  }
  heights_ = std::move(heights);
}

}  // namespace weft::character
