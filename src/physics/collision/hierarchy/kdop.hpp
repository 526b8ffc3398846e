// Discrete oriented polytopes (k-DOPs): bounds by k fixed directions (Etzmuß et al. 2001, "Bounding Volume Hierarchy",
// Eq. 3).
//
// A set of points is stored as its k support values: row r holds the minimum of direction_r · x over the set.
// Directions come in opposite pairs, rows 2d and 2d + 1, so the interval along pair d is [row(2d), -row(2d + 1)]. The
// k-DOP of the union of two sets is the row-wise minimum. Row r of set a plus row r ^ 1 (the opposite direction) of set
// b is the gap between them along direction r, times the length of direction r. Two k-DOPs overlap if no gap is
// positive.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/types.hpp"

namespace weft::collision {

/// Rows are padded to multiples of eight floats, so that joining two k-DOPs uses whole AVX registers.
template <int K>
inline constexpr int kRows = (K + 7) / 8 * 8;

/// The directions of a k-DOP. Their components are 0 or ±1, so that projections are short sums. Rows past K are zero.
template <int K>
struct Directions {
  static_assert(K == 6 || K == 18 || K == 26, "box; with edges; with corners and edges");
  std::array<double, kRows<K>> x{}, y{}, z{};
  std::array<double, kRows<K>> length{};

  constexpr Directions() {
    constexpr double corner[4][3] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    constexpr double edge[6][3] = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};
    int row = 0;
    const auto add = [&](double dx, double dy, double dz, double norm) {
      for (const double sign : {1.0, -1.0}) {
        x[row] = sign * dx, y[row] = sign * dy, z[row] = sign * dz;
        length[row++] = norm;
      }
    };
    add(1, 0, 0, 1), add(0, 1, 0, 1), add(0, 0, 1, 1);
    if (K == 26)
      for (const auto& d : corner) add(d[0], d[1], d[2], 1.7320508075688772);
    if (K >= 18)
      for (const auto& d : edge) add(d[0], d[1], d[2], 1.4142135623730951);
  }
};

template <int K>
inline constexpr Directions<K> kDirections{};

/// Support values of a set in single precision, rounded so that the bound may be too large but never too small.
template <int K>
struct alignas(32) KDop {
  float row[kRows<K>];

  /// Eq. (3): the k-DOP of a union of sets is the row-wise minimum of their k-DOPs.
  void join(const KDop& other) {
    for (int r = 0; r < kRows<K>; ++r) row[r] = std::min(row[r], other.row[r]);
  }

  /// Distance between the opposite faces of direction pair d [m].
  double side(int d) const {
    return (-static_cast<double>(row[2 * d]) - static_cast<double>(row[2 * d + 1])) / kDirections<K>.length[2 * d];
  }
};

/// The k-DOP of the segment from p to q, the trajectory of a vertex in one step, enlarged by `margin` [m] on every
/// side. Coordinates must be finite and below 1e37 m.
template <int K>
inline KDop<K> swept_point(const Vec3& p, const Vec3& q, double margin) {
  constexpr const Directions<K>& dir = kDirections<K>;
  // Rounding to float changes a value by at most 2^-24 of itself. Rounding the sum of three
  // products in double changes it by less than 2^-50 of the coordinates (not at all for 6
  // directions). The subtracted terms exceed both. The term 1e-38 exceeds the rounding of values
  // near zero, where floats are denormal.
  const double cancel = K == 6 ? 1e-38 : 1e-38 + 0x1p-50 * (p.cwiseAbs().sum() + q.cwiseAbs().sum() + margin);
  KDop<K> bound;
  for (int r = 0; r < kRows<K>; ++r) {
    const double at_p = dir.x[r] * p[0] + dir.y[r] * p[1] + dir.z[r] * p[2];
    const double at_q = dir.x[r] * q[0] + dir.y[r] * q[1] + dir.z[r] * q[2];
    const double low = std::min(at_p, at_q) - margin * dir.length[r];
    bound.row[r] = static_cast<float>(low - std::abs(low) * 0x1p-23 - cancel);
  }
  return bound;
}

/// Support values of a set whose points move linearly: rows 0 to K − 1 hold those at the start of the step, the next K
/// rows those at its end. The gap between two such sets along a direction is concave in time, so if it is positive at
/// the start and at the end, it is positive in between. Therefore two sets that move together with a gap along one
/// direction do not overlap.
template <int K>
struct alignas(32) MovingKDop {
  float row[(2 * K + 7) / 8 * 8];

  void join(const MovingKDop& other) {
    for (std::size_t r = 0; r < std::size(row); ++r) row[r] = std::min(row[r], other.row[r]);
  }

  /// Largest distance between two opposite faces of the k-DOP that contains the set at start and end [m].
  double longest_side() const {
    double longest = 0;
    for (int d = 0; d < K / 2; ++d) longest = std::max(longest, (-min_row(2 * d) - min_row(2 * d + 1)) / length(d));
    return longest;
  }

  /// Whether the sets may meet: false only if one direction separates them at the start and at the end.
  bool overlaps(const MovingKDop& other) const {
    for (int r = 0; r < K; ++r)
      if (row[r] + other.row[r ^ 1] > 0 && row[K + r] + other.row[(K + r) ^ 1] > 0) return false;
    return true;
  }

 private:
  double min_row(int r) const { return static_cast<double>(std::min(row[r], row[K + r])); }
  static double length(int d) { return kDirections<K>.length[2 * d]; }
};

/// Bound of a vertex that moves from p to any point of the box from `low` to `high`, enlarged by `margin` [m].
template <int K>
inline MovingKDop<K> moving_point(const Vec3& p, const Vec3& low, const Vec3& high, double margin) {
  const KDop<K> start = swept_point<K>(p, p, margin);
  KDop<K> end = swept_point<K>(low, high, margin);
  // `end` bounds the segment from `low` to `high`. Oblique directions need the other six corners of the box, too.
  if (K > 6 && low != high)
    for (int corner = 1; corner < 7; ++corner) {
      const Vec3 at(corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]);
      end.join(swept_point<K>(at, at, margin));
    }
  MovingKDop<K> bound{};
  std::copy_n(start.row, K, bound.row);
  std::copy_n(end.row, K, bound.row + K);
  return bound;
}

}  // namespace weft::collision
