// Interpolation of keyed vectors: piecewise linear, or a cubic spline that stays between its keys.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/motion/interpolation.hpp"

namespace weft::motion {

/// Second derivatives m at the keys of the natural cubic spline; they are zero at both ends. `h`: lengths of the
/// segments between keys; `d`: mean slopes of the segments (difference of values / length). Solves the tridiagonal
/// system, for each inner key i:
///   h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (d[i] - d[i-1])
template <class Value>
std::vector<Value> natural_second_derivatives(std::span<const double> h, std::span<const Value> d) {
  const std::size_t n = h.size();
  std::vector<Value> m(n + 1, Value::Zero());
  std::vector<double> diagonal(n + 1, 1.0);
  // The matrix is diagonally dominant, so elimination needs no pivoting.
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = i > 1 ? h[i - 1] / diagonal[i - 1] : 0.0;
    diagonal[i] = 2 * (h[i - 1] + h[i]) - (i > 1 ? factor * h[i - 1] : 0.0);
    m[i] = 6 * (d[i] - d[i - 1]) - factor * m[i - 1];
  }
  for (std::size_t i = n; i-- > 1;) m[i] = (m[i] - h[i] * m[i + 1]) / diagonal[i];
  return m;
}

/// Slopes at the keys of the natural cubic spline, limited per component so that the curve stays between the values of
/// neighbouring keys. `h`, `d`: as in natural_second_derivatives(). If the slopes d of the segments
/// on both sides of a key differ in sign or one of them is 0, the slope at the key is 0. Otherwise
/// the slope at the key is limited to the range from 0 to three times the d of smaller magnitude
/// (Fritsch & Carlson, "Monotone piecewise cubic interpolation", SIAM J. Numer. Anal. 17, 1980; for
/// slopes of splines: Hyman, SIAM J. Sci. Stat. Comput. 4, 1983). At the first and last key, the
/// only adjacent segment counts as both. Without the limit, an object may move backward before it
/// begins to move forward.
template <class Value>
std::vector<Value> slopes_between_keys(std::span<const double> h, std::span<const Value> d) {
  const std::size_t n = h.size();
  const std::vector<Value> m = natural_second_derivatives(h, d);
  std::vector<Value> slopes(n + 1, Value::Zero());
  for (std::size_t i = 0; i <= n && n > 0; ++i) {
    slopes[i] = i < n ? Value(d[i] - h[i] / 6 * (2 * m[i] + m[i + 1])) : Value(d[n - 1] + h[n - 1] / 6 * m[n - 1]);
    const Value &before = d[i > 0 ? i - 1 : 0], &after = d[i < n ? i : n - 1];
    for (Eigen::Index c = 0; c < slopes[i].size(); ++c) {
      const double steepest = before[c] * after[c] > 0 ? 3 * std::min(std::abs(before[c]), std::abs(after[c])) : 0;
      slopes[i][c] = after[c] > 0 ? std::clamp(slopes[i][c], 0.0, steepest) : std::clamp(slopes[i][c], -steepest, 0.0);
    }
  }
  return slopes;
}

/// Index of the segment that contains t; at a key, the later segment. Requires times.front() <= t < times.back().
inline std::size_t find_segment(std::span<const double> times, double t) {
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin()) - 1;
}

/// A vector-valued function of time through keys: piecewise linear, or cubic with the slopes of slopes_between_keys().
/// The cubic has a continuous first derivative between the first and the last key. Its second
/// derivative is continuous at a key if the slopes at this key and at both neighbouring keys are
/// not limited. Before the first key and from the last one on, the value is that of this key, and
/// derivatives are zero.
template <int Dim>
class Spline {
 public:
  using Value = Eigen::Matrix<double, Dim, 1>;

  struct Sample {
    Value value;                              ///< in the unit of the keys
    Value first_derivative = Value::Zero();   ///< [unit/s]; at a key of a linear spline, that of the later segment
    Value second_derivative = Value::Zero();  ///< [unit/s²]
  };

  /// Needs at least one key, as many values as times, and strictly increasing times [s].
  Spline(Interpolation interpolation, std::vector<double> times, std::vector<Value> values)
      : times_(std::move(times)), values_(std::move(values)) {
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
      lengths_.push_back(times_[i + 1] - times_[i]);
      chords_.push_back((values_[i + 1] - values_[i]) / lengths_.back());
    }
    if (interpolation == Interpolation::cubic) slopes_ = slopes_between_keys<Value>(lengths_, chords_);
    integrals_.push_back(Value::Zero());
    for (std::size_t i = 0; i + 1 < times_.size(); ++i)
      integrals_.push_back(integrals_[i] + integral_from_key(i, times_[i + 1]));
  }

  /// Takes time O(log keys); allocates nothing.
  Sample at(double t) const {
    if (t < times_.front() || times_.size() == 1) return {values_.front()};
    if (t >= times_.back()) return {values_.back()};
    const std::size_t i = find_segment(times_, t);
    const double s = t - times_[i], h = lengths_[i];
    if (slopes_.empty()) return {values_[i] + s * chords_[i], chords_[i]};
    const Value bend = (6 * chords_[i] - 4 * slopes_[i] - 2 * slopes_[i + 1]) / h;
    const Value jerk = 6 / (h * h) * (slopes_[i] + slopes_[i + 1] - 2 * chords_[i]);
    return {values_[i] + s * (slopes_[i] + s * (bend / 2 + s / 6 * jerk)), slopes_[i] + s * (bend + s / 2 * jerk),
            bend + s * jerk};
  }

  /// Integral of the value from t0 to t1 [unit · s].
  Value integral(double t0, double t1) const { return antiderivative(t1) - antiderivative(t0); }

 private:
  // Integral from the first key to t.
  Value antiderivative(double t) const {
    if (t < times_.front()) return (t - times_.front()) * values_.front();
    if (t >= times_.back()) return integrals_.back() + (t - times_.back()) * values_.back();
    const std::size_t i = find_segment(times_, t);
    return integrals_[i] + integral_from_key(i, t);
  }
  // Integral from key i to t, which is not later than the next key. Simpson's rule is exact for cubic polynomials.
  Value integral_from_key(std::size_t i, double t) const {
    return (t - times_[i]) / 6 * (values_[i] + 4 * at(0.5 * (times_[i] + t)).value + at(t).value);
  }

  std::vector<double> times_;
  std::vector<Value> values_;
  std::vector<double> lengths_;   ///< of the segments [s]
  std::vector<Value> chords_;     ///< mean slopes of the segments
  std::vector<Value> slopes_;     ///< at the keys; empty for linear splines
  std::vector<Value> integrals_;  ///< from the first key to each key
};

}  // namespace weft::motion
