// Broad phase with reuse: collects candidate pairs of triangles and keeps them while they stay valid.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/bodies.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/variants/coherence.hpp"

namespace weft::collision {

struct SearchParameters {
  bool self = true;        ///< cloth against itself and other cloth
  bool obstacles = true;   ///< cloth or rigid bodies against obstacles or rigid bodies
  bool reuse = true;       ///< keep candidate pairs for several steps, while no vertex has moved far
  bool coherence = false;  ///< keep closest points instead of candidate pairs (see CoherentDetection)
  BroadPhaseOptions broad_phase = {};
};

/// Collects candidate pairs: pairs of triangles whose bounds overlap on the linear trajectories from x_t0 to x_t1. The
/// bounds are enlarged by a margin at both ends. The margin is half the detection distance, below which features are
/// near. With SearchParameters::reuse, it is larger in slow steps, by a Verlet margin of 2 · Numerics::Contact::margin
/// detection distances. A step is slow if no vertex moves as far as the Verlet margin along an axis.
///
/// The pairs stay valid while each vertex starts within the Verlet margin of its start at the search and ends inside
/// its bounds. Features that are near at such starts were closer than radius() at the search. Thus cloth at rest is
/// searched only once.
///
/// A clear obstacle is one that an axis-aligned plane separates from all particles. While it stays on its side of that
/// plane, its motion is ignored: it neither makes a step fast nor invalidates the pairs.
///
/// Bounds at the start and at the end are compared separately. So triangles that move together with a gap between them
/// are no candidate pair (sphere_drape at 256²: 4 pairs per particle; 70 with one bound for the whole trajectory).
class CandidateCache {
 public:
  /// `bodies` must outlive it. `x`: all vertices at the start of the run [m]. `detection_distance`: in [m].
  CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x,
                 double detection_distance);

  /// Replaces pairs() by all pairs of triangles that can come within the detection distance on the trajectory from x_t0
  /// to x_t1, and sets the bounds that covers_start() and covers_end() test. The caller may remove pairs from the list.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Collects again after pushing apart has moved vertices to x_t1. If a vertex has left the bounds of its end, these
  /// bounds grow to contain its start and its x_t1, because the vertex may be backtracked from there to its start.
  /// `all`: the bounds of every vertex grow.
  CandidatePairs& collect_more(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, bool all);

  /// As the first collect(), but each vertex may end anywhere in the box between `low_t1` and `high_t1`.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> low_t1, std::span<const Vec3> high_t1);

  /// The list that collect() fills.
  CandidatePairs& pairs() { return pairs_; }

  /// Features that are near at a covered x_t0 were closer than this when the pairs were collected [m].
  double radius() const { return 2 * margin_; }
  double detection_distance() const { return detection_distance_; }

  /// Whether each vertex at x is kept clear (is_kept_clear()) or within the Verlet margin of its start at the search
  /// (if the search had no Verlet margin: exactly there). This function and the next two return false if no pairs are
  /// valid.
  bool covers_start(std::span<const Vec3> x) const;
  /// Whether each vertex at x is kept clear or inside the bounds of its end. If so, the pairs include all that can meet
  /// on the trajectory from a covered start to x.
  bool covers_end(std::span<const Vec3> x) const;

  /// True only if the pairs contain all features that are near when the vertices end at x.
  bool lists_near(std::span<const Vec3> x) const;

  /// Whether a vertex at x lies in the half-space that contains its obstacle and no particle; false if no such
  /// half-space is known.
  bool is_kept_clear(std::size_t vertex, const Vec3& x) const;

  /// For callers that collect pairs themselves: declares the pairs valid for ends within `margin` [m] of x_t1, and for
  /// starts within (`margin` − half the detection distance) of x_t0.
  void cover(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    find_clear_bodies(Motion(x_t0, x_t1));
    cover(Motion(x_t0, x_t1), margin);
  }

  /// Whether this body is a clear obstacle: no particle can meet it while covers_start() and covers_end() are true.
  bool is_clear(std::size_t body) const { return clear_[body].sign != 0; }

  /// The pairs of surfaces (a < b, or a = b) to search.
  const std::vector<SurfacePair>& surface_pairs() const { return surface_pairs_; }
  /// The hierarchies. Their bounds contain the vertices on every covered trajectory, except those of clear obstacles.
  BroadPhase& hierarchies() { return broad_phase_; }
  const BroadPhase& hierarchies() const { return broad_phase_; }

  /// Invalidates the pairs: nothing is covered from now on.
  void invalidate() { margin_ = -1; }

  /// Call between two steps. Makes later results independent of earlier steps.
  void forget();

  /// Starts and boxes of the ends for which the pairs were collected. Collecting for them again gives the same pairs.
  std::span<const Vec3> from() const { return from_; }
  std::span<const Vec3> low_end() const { return low_; }
  std::span<const Vec3> high_end() const { return high_.empty() ? low_ : high_; }

 private:
  void cover(const Motion& motion, double margin);
  void refit(const Motion& motion, double margin);
  void find_clear_bodies(const Motion& motion);
  bool is_at_end(std::size_t vertex, const Vec3& x, double margin) const;

  const Bodies& bodies_;
  SearchParameters parameters_;
  double detection_distance_;
  BroadPhase broad_phase_;
  std::vector<SurfacePair> surface_pairs_;
  CandidatePairs pairs_;
  std::vector<Vec3> from_, low_, high_;  // see from(), low_end(), high_end(); high_ is empty if it equals low_
  double margin_ = -1;                   // of pairs_ [m]; negative: no valid pairs
  /// Half-space without particles: sign · x[axis] >= from. A trajectory with both ends inside stays inside.
  struct HalfSpace {
    int axis = 0;
    double sign = 0;                                        // ±1; 0: no such half-space
    double from = std::numeric_limits<double>::infinity();  // [m]
    bool holds(const Vec3& x) const { return sign * x[axis] >= from; }
  };
  std::vector<HalfSpace> clear_;  // per body: if it is a clear obstacle, a half-space that contains it
};

}  // namespace weft::collision
