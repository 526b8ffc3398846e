// Detection results kept while nothing moves much relative to anything near it (seed, "Detection Process": velocity
// cones).
//
//   CoherentDetection kept(surfaces, x, reach, budget);
//   each step:  kept.advance(x_t0, x_t1);
//               for surfaces a ≤ b:  if (!kept.holds(a, b))
//                                      find candidates with margin (reach + budget) / 2 and proximities below
//                                      reach + budget at x_t0, and kept.keep(a, b, candidates, proximities);
//                                    kept.candidates(a, b); kept.proximities(a, b, x_t0, out);
//
// Each surface is cut into groups of triangles with a velocity cone each: the motion since a common reference. Let R be
// the bound that the cones of two groups give on how far a point of one has moved relative to a point of the other
// since their pair of surfaces was kept. Distances change by R at most, and so do the gaps of bounds along any
// direction. A result holds while for each two groups either R ≤ budget, or they were more than reach + R apart when it
// was kept, so the period of reuse follows from the velocities and from budget, a part of ε_close. While it holds:
//   - every two triangles whose bounds with margin reach / 2 overlap now are among the candidates;
//   - a kept pair of closest points, weights as they were, is at most 2 R farther apart than its features are, and
//   never
//     nearer than they are;
//   - for every pair of features within reach a listed pair is at most 2 R farther apart (see ProximityFinder; within
//     reach now was within reach + R then, and the pair that stood for it was no farther).
// Surfaces are kept or found as a whole, because a proximity may stand for others in neighbouring groups.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "collision/hierarchy/velocity_cone.hpp"
#include "collision/proximity/proximities.hpp"

namespace weft::collision {

class CoherentDetection {
 public:
  CoherentDetection() = default;
  /// reach and budget in [m].
  CoherentDetection(std::span<const Surface> surfaces, std::span<const Vec3> x, double reach, double budget);

  /// Velocity cones for the step from x_t0 to x_t1 [m]. Every kReferenceSteps the reference is set anew and nothing
  /// holds, so that the cones of old references do not add up.
  void advance(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  bool holds(std::size_t a, std::size_t b);
  void keep(std::size_t a, std::size_t b, const CandidatePairs& candidates, std::span<const Proximity> proximities);

  const CandidatePairs& candidates(std::size_t a, std::size_t b) const { return kept_.at({a, b}).candidates; }
  /// Appends the kept proximities with the distances and normals that their weights give at x [m] now, as far as these
  /// are below reach + 2 R.
  void proximities(std::size_t a, std::size_t b, std::span<const Vec3> x, std::vector<Proximity>& out) const;
  /// The largest R [m] of those that must be below the budget, as of the last holds().
  double motion_since(std::size_t a, std::size_t b) const { return kept_.at({a, b}).motion; }

  static constexpr int kReferenceSteps = 64;

 private:
  struct Group {
    std::vector<Index> vertices;
    Vec3 low, high;  // box of the way from x_t0 to x_t1
    VelocityCone cone;
  };
  struct Kept {
    CandidatePairs candidates;
    std::vector<Proximity> proximities;
    std::vector<Group> groups_a, groups_b;  // as they were, without vertices
    double motion = 0;
  };

  void add_groups(const Surface& surface, std::span<const Vec3> x, std::vector<Group>& groups) const;

  double reach_ = 0, budget_ = 0;
  int steps_ = 0;
  std::vector<Vec3> reference_t0_, reference_t1_;
  std::vector<std::vector<Group>> groups_;  // by surface
  std::map<std::pair<std::size_t, std::size_t>, Kept> kept_;
};

}  // namespace weft::collision
