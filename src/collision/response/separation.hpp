// The guarantee: no two triangles meet during a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "collision/proximity/closest_points.hpp"
#include "core/types.hpp"

namespace weft::collision {

struct SeparationReport {
  bool separated = false;      ///< every pair has a certificate
  int corrected_pairs = 0;     ///< pairs that needed a correction
  double largest_push = 0;     ///< [m]
  TrianglePair stuck{-1, -1};  ///< a pair that could not be separated, where not `separated`
};

/// Keeps triangle pairs apart over the linear motion from x_t0 to x_t1 by moving dividing planes.
///
/// Certificate of a pair (A, B): a direction n with gap(t) = min_A n·x − max_B n·x > 0 at the start and at the end.
/// Every n·x is linear in time, so the gap is a minimum of linear functions, concave, and positive all the way between:
/// a plane normal to n that moves along with the pair divides them for the whole step. No root is sought and no
/// tolerance enters but the rounding of a dot product, 1e-15 of the coordinates, against a floor of 1e-6 m.
///
/// A pair without certificate has its end positions pushed apart along n, the closest direction at the start, until a
/// gap remains: by half each, obstacles and held particles not at all. What was moved is checked again, until nothing
/// fails. Particles that keep failing are drawn back to where they started.
class Separation {
 public:
  Separation() = default;
  /// `triangles`: of all surfaces, by global number.
  explicit Separation(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {}

  /// Changes x_t1 of vertices with `movable` 1 (free particles). x_t0 must be free of intersections. `pairs` must hold
  /// all that can meet; where a correction carries a vertex out of the bounds they were collected with, collect and
  /// call again.
  SeparationReport enforce(std::span<const TrianglePair> pairs, std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                           std::span<const std::uint8_t> movable);

  /// Pairs without a certificate for the way to x_t1; changes nothing.
  std::span<const TrianglePair> find_failing(std::span<const TrianglePair> pairs, std::span<const Vec3> x_t0,
                                             std::span<const Vec3> x_t1);

 private:
  struct Corners {
    std::array<Vec3, 3> t0, t1;
  };
  Corners corners(Index triangle, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const;
  Vec3 direction_between(const TrianglePair& pair, std::span<const Vec3> x) const;
  bool certified(const TrianglePair& pair, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) const;
  bool push_apart(const TrianglePair& pair, std::span<const Vec3> x_t0, std::span<Vec3> x_t1,
                  std::span<const std::uint8_t> movable, int round, SeparationReport& report);

  std::vector<Triangle> triangles_;
  std::vector<int> changed_in_;  // per vertex: round in which it was last moved, 0 never
  std::vector<TrianglePair> failing_;
};

/// The closest pair of features of two triangles without a common vertex.
struct ClosestFeatures {
  std::array<Index, 4> vertices{};  ///< global numbers
  ClosestPoints points{};           ///< weights of the vertices; difference from b to a
};
ClosestFeatures closest_features(const Triangle& a, const Triangle& b, std::span<const Vec3> x);

}  // namespace weft::collision
