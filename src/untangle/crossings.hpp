// Where edges go through triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "untangle/problem.hpp"

namespace weft::untangle {

struct Crossing {
  Index edge;                     ///< of Fabric::edges
  Index triangle;                 ///< global number
  double share;                   ///< of the way from the edge's first to its second vertex
  std::array<double, 3> weights;  ///< of the triangle's corners
};

/// Whether one of the two is of an obstacle with an inside, or a layer.
bool with_solid(const Fabric& fabric, const Crossing& crossing);

/// Of the surfaces of which one at least is cloth.
class CrossingFinder {
 public:
  /// `self`: cloth with cloth; `obstacles`: cloth with obstacles. The fabric must outlive it.
  CrossingFinder(const Fabric& fabric, std::span<const Vec3> x, bool self, bool obstacles);

  /// All at x [m], sorted by edge and triangle, each once. Touching counts.
  std::span<const Crossing> find(std::span<const Vec3> x);
  /// Pairs of triangles among the last that were found.
  int pairs() const { return pairs_; }

  /// Pairs of triangles without a common vertex whose boxes are within `distance` [m] of each other.
  std::span<const collision::TrianglePair> near(std::span<const Vec3> x, double distance);

  const collision::BroadPhase& surfaces() const { return broad_phase_; }

 private:
  void collect(std::span<const Vec3> x, double margin);
  bool test(Index of_edge, Index triangle, Index without, std::span<const Vec3> x);

  const Fabric& fabric_;
  collision::BroadPhase broad_phase_;
  std::vector<std::array<std::size_t, 2>> wanted_;
  collision::CandidatePairs candidates_;
  std::vector<Crossing> crossings_;
  int pairs_ = 0;
};

}  // namespace weft::untangle
