// Finds the nearest of many points.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace weft {

/// Points in space, sorted into cubes, to find the nearest one within a radius.
class NearPoints {
 public:
  /// `radius`: edge length of the cubes [m].
  explicit NearPoints(double radius) : radius_(radius) {}

  void add(const Vec3& x) { cubes_[key(cube_of(x))].emplace_back(count_++, x); }

  struct Nearest {
    Index point = -1;                                              ///< in the order of add(); −1: none
    double distance_sq = std::numeric_limits<double>::infinity();  ///< [m²]
  };
  /// The nearest point. If no point is within the radius, none, or a point that is farther away.
  Nearest nearest(const Vec3& x) const {
    const Cube middle = cube_of(x);
    Nearest best;
    for (int n = 0; n < 27; ++n) {
      const auto found = cubes_.find(key({middle[0] + n / 9 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n % 3 - 1}));
      if (found == cubes_.end()) continue;
      for (const auto& [point, place] : found->second)
        if (const double d = (place - x).squaredNorm(); d < best.distance_sq) best = {point, d};
    }
    return best;
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  Cube cube_of(const Vec3& x) const {
    const auto along = [&](double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate / radius_)); };
    return {along(x.x()), along(x.y()), along(x.z())};
  }
  /// Key of a cube, with 21 bits per axis. Cubes two million cubes apart may share a key, which only costs time.
  static std::uint64_t key(const Cube& cube) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(cube[0]) & kMask) << 42 | (static_cast<std::uint64_t>(cube[1]) & kMask) << 21 |
           (static_cast<std::uint64_t>(cube[2]) & kMask);
  }

  double radius_;
  Index count_ = 0;
  std::unordered_map<std::uint64_t, std::vector<std::pair<Index, Vec3>>> cubes_;
};

}  // namespace weft
