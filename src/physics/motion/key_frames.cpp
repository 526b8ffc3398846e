#include "physics/motion/key_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/parallel.hpp"

namespace weft::motion {

KeyFrames::KeyFrames(Interpolation interpolation, double first_time, double interval,
                     std::vector<std::vector<Vec3>> keys, bool from_rest)
    : first_time_(first_time), interval_(interval), keys_(std::move(keys)) {
  if (interpolation == Interpolation::cubic && is_moving()) compute_second_derivatives(from_rest);
}

/// Computes the second derivatives m at the keys. x: positions at the keys; h = interval_. Solves the system of
/// natural_second_derivatives() (spline.hpp) for equal segment lengths h, divided by h:
///   m[i-1] + 4 m[i] + m[i+1] = 6 (x[i-1] - 2 x[i] + x[i+1]) / h²
/// with m = 0 at the end. At the start, m = 0; or, for zero velocity, 2 m[0] + m[1] = 6 (x[1] - x[0]) / h².
void KeyFrames::compute_second_derivatives(bool from_rest) {
  const std::size_t n = keys_.size(), vertices = keys_.front().size();
  const double factor = 6 / (interval_ * interval_);
  second_derivatives_.assign(n, std::vector<Vec3>(vertices, Vec3::Zero()));
  // The elimination is the same for all vertices: row i gives m[i] = (right side) - upper[i] m[i+1].
  std::vector<double> upper(n, 0.0), pivot(n, 1.0);
  if (from_rest) {
    pivot[0] = 2;
    upper[0] = 0.5;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    pivot[i] = 4 - upper[i - 1];
    upper[i] = 1 / pivot[i];
  }
  parallel_for(vertices, kGrainSize, [&](std::size_t begin, std::size_t end) {
    if (from_rest)
      for (std::size_t v = begin; v < end; ++v)
        second_derivatives_[0][v] = factor * (keys_[1][v] - keys_[0][v]) / pivot[0];
    for (std::size_t i = 1; i + 1 < n; ++i)
      for (std::size_t v = begin; v < end; ++v)
        second_derivatives_[i][v] =
            (factor * (keys_[i - 1][v] - 2 * keys_[i][v] + keys_[i + 1][v]) - second_derivatives_[i - 1][v]) / pivot[i];
    for (std::size_t i = n - 1; i-- > 0;)
      for (std::size_t v = begin; v < end; ++v) second_derivatives_[i][v] -= upper[i] * second_derivatives_[i + 1][v];
  });
}

KeyFrames::Piece KeyFrames::find_piece(double t) const {
  const double place = (t - first_time_) / interval_;
  const auto last = static_cast<double>(keys_.size() - 1);
  const bool is_still = !(place >= 0) || place >= last;
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, last));
  return {i, is_still ? 0 : t - first_time_ - static_cast<double>(i) * interval_, is_still};
}

VertexMotion KeyFrames::at(const Piece& piece, std::size_t v) const {
  const auto& [i, s, is_still] = piece;
  if (is_still) return {keys_[i][v], Vec3::Zero(), Vec3::Zero()};
  const double h = interval_;
  Vec3 slope = (keys_[i + 1][v] - keys_[i][v]) / h, bend = Vec3::Zero(), jerk = Vec3::Zero();
  if (!second_derivatives_.empty()) {
    bend = second_derivatives_[i][v];
    jerk = (second_derivatives_[i + 1][v] - bend) / h;
    slope -= h / 6 * (2 * bend + second_derivatives_[i + 1][v]);
  }
  return {keys_[i][v] + s * (slope + s * (bend / 2 + s / 6 * jerk)), slope + s * (bend + s / 2 * jerk),
          bend + s * jerk};
}

void KeyFrames::at(double t, std::span<Vec3> positions) const {
  const Piece now = find_piece(t);
  parallel_for(positions.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) positions[v] = at(now, v).position;
  });
}

std::vector<double> KeyFrames::times() const {
  std::vector<double> times;
  for (std::size_t k = 0; k < keys_.size(); ++k) times.push_back(first_time_ + static_cast<double>(k) * interval_);
  return times;
}

std::size_t KeyFrames::bytes() const {
  return (keys_.size() + second_derivatives_.size()) * keys_.front().size() * sizeof(Vec3);
}

}  // namespace weft::motion
