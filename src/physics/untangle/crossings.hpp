// Finds where edges cross triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// An edge that crosses a triangle.
struct Crossing {
  Index edge;                     ///< index into UntangleInput::edges.edges
  Index triangle;                 ///< index into Bodies::triangles()
  double fraction;                ///< position on the edge, from its first vertex (0) to its second (1)
  std::array<double, 3> weights;  ///< barycentric, of the crossing point in the triangle
};

/// Whether the edge or the triangle belongs to a solid, a floor or a layer.
bool involves_solid(const UntangleInput& input, const Crossing& crossing);

/// Finds crossings between surfaces of which at least one is SurfaceKind::cloth.
class CrossingFinder {
 public:
  /// `self`: whether to test cloth with cloth, too. The input must outlive the finder.
  CrossingFinder(const UntangleInput& input, std::span<const Vec3> x, bool self);

  /// All crossings at x [m], sorted by edge and triangle, each once. An edge that touches a triangle also crosses it,
  /// except if it lies in the triangle's plane.
  std::span<const Crossing> find(std::span<const Vec3> x);
  /// Number of crossing pairs of triangles in the last find().
  int pairs() const { return pairs_; }

  /// Pairs of triangles without a common vertex, of the surfaces that find() tests, whose bounding boxes overlap if
  /// enlarged by `distance` / 2 [m] on each side.
  std::span<const collision::TrianglePair> find_near_pairs(std::span<const Vec3> x, double distance);

  const collision::BroadPhase& surfaces() const { return broad_phase_; }

 private:
  void collect(std::span<const Vec3> x, double margin);
  bool test(Index of_edge, Index triangle, Index without, std::span<const Vec3> x);

  const UntangleInput& input_;
  collision::BroadPhase broad_phase_;
  std::vector<std::array<std::size_t, 2>> tested_body_pairs_;  // pairs of bodies to test
  collision::CandidatePairs candidates_;
  std::vector<Crossing> crossings_;
  int pairs_ = 0;
};

}  // namespace weft::untangle
