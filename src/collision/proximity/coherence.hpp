// Detection results kept while nothing moves much relative to anything near it (seed, "Detection Process": velocity
// cones).
//
//   CoherentDetection detection(surfaces, {{0, 0}, {0, 1}}, x, {.reach = …, .budget = …});
//   each step:  if (detection.update(broad_phase, finder, x_t0, x_t1) > 0) … detection.candidates() are others now
//               detection.proximities()
//
// Each surface is cut into groups of triangles with a velocity cone each: the motion since a common reference. Let R be
// the bound that the cones of two groups give on how far a point of one has moved relative to a point of the other
// since their pair of surfaces was searched. Distances change by R at most, and so do the gaps of bounds along any
// direction. A result holds while for each two groups either R ≤ budget, or they were more than reach + R apart when it
// was found, so the period of reuse follows from the velocities and from budget, a part of ε_close. While it holds:
//   - every two triangles whose bounds with margin reach / 2 overlap now are among the candidates;
//   - a kept pair of closest points, weights as they were, is at most 2 R farther apart than its features are, and
//     never nearer than they are;
//   - for every pair of features within reach a listed pair is at most 2 R farther apart (see ProximityFinder; within
//     reach now was within reach + R then, and the pair that stood for it was no farther).
// Surfaces are kept or searched as a whole, because a proximity may stand for others in neighbouring groups.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "collision/hierarchy/surface.hpp"
#include "collision/hierarchy/velocity_cone.hpp"
#include "collision/proximity/proximities.hpp"

namespace weft::collision {

/// Two surfaces that can meet, by number, a < b; a = b: a surface with itself.
struct SurfacePair {
  std::size_t a = 0, b = 0;
};

struct CoherenceParameters {
  double reach = 0;     ///< of proximities [m]
  double budget = 0;    ///< relative motion that a result survives [m]
  double flattest = 0;  ///< of edges, as for ProximityFinder::gather
};

class CoherentDetection {
 public:
  CoherentDetection() = default;
  /// `surfaces`: in the numbering of the broad phase and the finder; `wanted`: those pairs of them that are looked at.
  CoherentDetection(std::span<const Surface> surfaces, std::vector<SurfacePair> wanted, std::span<const Vec3> x,
                    const CoherenceParameters& parameters);

  /// Brings everything up to the step from x_t0 to x_t1 [m]. Fits all bounds, for candidates of those pairs of surfaces
  /// whose result does not hold, and returns how many these are: where none, the candidates are the same as before.
  /// Call it again where the motion is another one than was expected.
  int update(BroadPhase& broad_phase, ProximityFinder& finder, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Of all wanted pairs of surfaces.
  const CandidatePairs& candidates() const { return candidates_; }
  /// With the distances and normals that the weights give at x_t0; kept ones up to reach + 2 R.
  std::span<const Proximity> proximities() const { return proximities_; }
  /// The largest R [m] of those that are within the budget.
  double largest_motion() const { return largest_motion_; }

  /// The next update finds everything anew: nothing depends on what was before.
  void forget() { updates_ = 0; }

 private:
  struct Group {
    std::vector<Index> vertices;
    Vec3 low, high;  // box of the way from x_t0 to x_t1
    VelocityCone cone;
  };
  struct GroupThen {
    Vec3 low, high;
    VelocityCone cone;
  };
  /// What was found for one wanted pair of surfaces, and how their groups were then.
  struct Kept {
    bool valid = false;
    CandidatePairs candidates;
    std::vector<Proximity> proximities;
    std::vector<GroupThen> groups_a, groups_b;
    double motion = 0;
  };

  void add_groups(const Surface& surface, std::span<const Vec3> x);
  void advance(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  bool holds(const SurfacePair& pair, Kept& kept) const;
  void find_anew(const std::vector<std::size_t>& pairs, BroadPhase& broad_phase, ProximityFinder& finder,
                 std::span<const Vec3> x_t0);
  void append_proximities(const Kept& kept, std::span<const Vec3> x);

  std::vector<Surface> surfaces_;
  std::vector<SurfacePair> wanted_;
  CoherenceParameters parameters_;
  std::vector<Kept> kept_;                  // by wanted pair
  std::vector<std::vector<Group>> groups_;  // by surface
  int updates_ = 0;
  std::vector<Vec3> reference_t0_, reference_t1_;
  CandidatePairs candidates_;
  std::vector<Proximity> proximities_;
  double largest_motion_ = 0;
};

}  // namespace weft::collision
