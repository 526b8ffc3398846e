// Keeps detection results while nothing moves much relative to its neighbours (Etzmuß et al. 2001, "Detection
// Process").
//
//   CoherentDetection detection(surfaces, {{0, 0}, {0, 1}}, x, {.detection_distance = …, .budget = …});
//   each step:  if (detection.update(broad_phase, finder, x_t0, x_t1) > 0) … detection.candidates() have changed
//               detection.proximities()
//
// Each surface is divided into groups of triangles. A velocity cone bounds the motion of each group
// since a common reference step. For two groups, their cones give a bound R of the motion of a
// point of one group relative to a point of the other since the last search of their surfaces. So
// since that search, the distance between any two points of the groups, and the gap between their
// bounding volumes along any direction, have changed by at most R. Let D be the detection distance.
// The result of that search is valid while every two groups have R ≤ budget, or had boxes that were
// more than D + R apart along an axis at the search. While a result is valid:
//   - every two triangles whose bounds with margin D / 2 overlap now are among the candidates;
//   - the kept closest points of two features, with unchanged weights, are at least as far apart as the features, and
//     at most 2 R farther;
//   - for every two features within D of each other, some listed pair is at most 2 R farther apart than they are. (At
//     the search, the two features were within D + R of each other, and the listed pair that represented them was at
//     most as far apart; see ProximityFinder.)
//
// A pair of surfaces is searched as a whole, because a near pair may represent pairs in neighbouring groups.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/proximity/proximities.hpp"
#include "physics/collision/variants/velocity_cone.hpp"

namespace weft::collision {

/// Two surfaces that can meet, by number: a < b, or a = b for a surface that can meet itself.
struct SurfacePair {
  std::size_t a = 0, b = 0;
};

struct CoherenceParameters {
  double detection_distance = 0;  ///< [m]
  double budget = 0;              ///< relative motion up to which a result stays valid [m]
  double min_fold = 0;            ///< as for ProximityFinder::gather
};

class CoherentDetection {
 public:
  /// `surfaces`: numbered as in the broad phase and the finder. `surface_pairs`: the pairs of surfaces to search.
  CoherentDetection(std::span<const Surface> surfaces, std::vector<SurfacePair> surface_pairs, std::span<const Vec3> x,
                    const CoherenceParameters& parameters);

  /// Updates the results to the step from x_t0 to x_t1 [m]. Refits all bounds, searches the pairs of surfaces whose
  /// result is no longer valid, and returns their number; 0: the candidates are unchanged. Call again if x_t1 changes
  /// within the step.
  int update(BroadPhase& broad_phase, ProximityFinder& finder, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Candidate pairs of all listed pairs of surfaces.
  const CandidatePairs& candidates() const { return candidates_; }
  /// Near pairs, with distances and normals that follow from the kept weights at x_t0. A pair of
  /// features is listed if its distance is below D + 2 R, where R is the largest bound of its pair
  /// of surfaces.
  std::span<const Proximity> proximities() const { return proximities_; }
  /// Largest R of all pairs of groups whose boxes were at most D + R apart at the search [m]; at most the budget.
  double largest_motion() const { return largest_motion_; }

  /// Makes the next update search all pairs of surfaces, so that its results do not depend on
  /// earlier steps.
  void forget() { updates_ = 0; }

 private:
  struct Group {
    std::vector<Index> vertices;
    Vec3 low, high;  // box of the trajectories from x_t0 to x_t1
    VelocityCone cone;
  };
  struct GroupSnapshot {
    Vec3 low, high;
    VelocityCone cone;
  };
  /// Kept result for one pair of surfaces, and the state of their groups at its search.
  struct KeptResult {
    bool valid = false;
    CandidatePairs candidates;
    std::vector<Proximity> proximities;
    std::vector<GroupSnapshot> groups_a, groups_b;
    double motion = 0;  ///< as largest_motion(), for this pair of surfaces [m]
  };

  void add_groups(const Surface& surface, std::span<const Vec3> x);
  void update_cones(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
  bool is_still_valid(const SurfacePair& pair, KeptResult& kept) const;
  void search_again(const std::vector<std::size_t>& pairs, BroadPhase& broad_phase, ProximityFinder& finder,
                    std::span<const Vec3> x_t0);
  void append_proximities(const KeptResult& kept, std::span<const Vec3> x);

  std::vector<Surface> surfaces_;
  std::vector<SurfacePair> surface_pairs_;
  CoherenceParameters parameters_;
  std::vector<KeptResult> kept_;            // by pair of surfaces
  std::vector<std::vector<Group>> groups_;  // by surface
  int updates_ = 0;
  std::vector<Vec3> reference_t0_, reference_t1_;
  CandidatePairs candidates_;
  std::vector<Proximity> proximities_;
  double largest_motion_ = 0;
};

}  // namespace weft::collision
