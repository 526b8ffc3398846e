// Interpolation of keyed vectors: piecewise linear, or a natural cubic spline.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// Second derivatives at the keys of the natural cubic spline (zero at both ends) with the given segment lengths `h`
/// and slopes `d` (difference of values by length). Standard tridiagonal system, for inner keys i:
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

/// Segment of strictly increasing key times that holds t; the one to the right of a key. Call with
/// times.front() <= t < times.back().
inline std::size_t find_segment(std::span<const double> times, double t) {
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin()) - 1;
}

/// A vector-valued function of time through keys. Cubic: the natural cubic spline, twice continuously differentiable
/// between the first and the last key. Outside of them the end value holds and derivatives vanish.
template <int Dim>
class Spline {
 public:
  using Value = Eigen::Matrix<double, Dim, 1>;

  struct Sample {
    Value value;                              ///< in the unit of the keys
    Value first_derivative = Value::Zero();   ///< per s; at a corner of a linear track that of the later segment
    Value second_derivative = Value::Zero();  ///< per s²
  };

  /// At least one key; times [s] strictly increasing, as many as values.
  Spline(scene::Interpolation interpolation, std::vector<double> times, std::vector<Value> values)
      : times_(std::move(times)), values_(std::move(values)) {
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
      lengths_.push_back(times_[i + 1] - times_[i]);
      slopes_.push_back((values_[i + 1] - values_[i]) / lengths_.back());
    }
    second_derivatives_ = interpolation == scene::Interpolation::cubic
                              ? natural_second_derivatives<Value>(lengths_, slopes_)
                              : std::vector<Value>(times_.size(), Value::Zero());
  }

  /// Time O(log keys); allocates nothing.
  Sample at(double t) const {
    if (t < times_.front() || times_.size() == 1) return {values_.front()};
    if (t >= times_.back()) return {values_.back()};
    const std::size_t i = find_segment(times_, t);
    const double s = t - times_[i], h = lengths_[i];
    const Value jerk = (second_derivatives_[i + 1] - second_derivatives_[i]) / h;
    const Value start_slope = slopes_[i] - h / 6 * (2 * second_derivatives_[i] + second_derivatives_[i + 1]);
    return {values_[i] + s * (start_slope + s * (second_derivatives_[i] / 2 + s / 6 * jerk)),
            start_slope + s * (second_derivatives_[i] + s / 2 * jerk), second_derivatives_[i] + s * jerk};
  }

 private:
  std::vector<double> times_;
  std::vector<Value> values_;
  std::vector<double> lengths_;            ///< of the segments [s]
  std::vector<Value> slopes_;              ///< of the chords
  std::vector<Value> second_derivatives_;  ///< at the keys; zero for linear tracks
};

}  // namespace weft::environment
