// Which pairs of triangles can meet, and for how long that holds.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "collision/bodies.hpp"
#include "collision/hierarchy/broad_phase.hpp"
#include "collision/proximity/coherence.hpp"
#include "core/types.hpp"

namespace weft::collision {

struct SearchParameters {
  bool self = true;        ///< cloth against itself and other cloth
  bool obstacles = true;   ///< cloth against obstacles
  bool reuse = true;       ///< of candidates while nothing has moved far
  bool coherence = false;  ///< of closest points instead, by velocity cones (see CoherentDetection)
  BroadPhaseOptions broad_phase = {};
};

/// Pairs are collected for the way of all vertices from x_t0 to x_t1, with bounds enlarged by a margin at both ends.
/// They hold for every other way whose ends are inside those bounds, and what was near the reach then tells who can be
/// within it while no vertex has left its start by more than the rest of the margin: cloth at rest is searched once.
/// An obstacle that an axis keeps clear of all cloth is left alone while that axis does: however it moves, it changes
/// neither what is collected nor when.
/// What moves along with each other is not listed: bounds of the whole way, from start to end, listed 70 pairs a
/// particle where those of its ends list 4 (sphere_drape at 256², falling over the edge of the ball).
class CandidateCache {
 public:
  /// `bodies` must outlive it. `x`: all vertices at the start [m]; `reach`: distance below which features are near [m].
  CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x, double reach);

  /// All pairs of triangles that can come within the reach on the way from x_t0 to x_t1, and from now on the bounds
  /// that covers_start() and covers_end() speak of. Who asked may thin them out.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// The same, besides for all that was covered before; x_t1 is where pushing apart has led to. Vertices that it has
  /// carried out of their bounds may end anywhere between start and end from then on, as those do that are taken back:
  /// all of them where `all` says so.
  CandidatePairs& collect_more(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, bool all);

  /// The same for ends anywhere between two corners, for each vertex.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> low_t1, std::span<const Vec3> high_t1);

  /// Where collect() lists them.
  CandidatePairs& pairs() { return pairs_; }

  /// Distance at the start of the collection below which features are that can be within the reach at an x_t0 that is
  /// covered [m].
  double radius() const { return 2 * margin_; }
  double reach() const { return reach_; }

  /// Whether features that are within the reach at x were within the radius when the pairs were collected.
  bool covers_start(std::span<const Vec3> x) const;
  /// Whether x is inside the bounds of the end: the pairs hold all that can meet on a way from a start that is covered
  /// to there.
  bool covers_end(std::span<const Vec3> x) const;

  /// Whether features that are within the reach at x, an end of the way, are listed.
  bool lists_near(std::span<const Vec3> x) const;

  /// Whether x is where all vertices of this one's body are out of the way of all cloth.
  bool is_kept_clear(std::size_t vertex, const Vec3& x) const;

  /// For who collects by other means: pairs hold for ways within `margin` [m] of the one from x_t0 to x_t1.
  void cover(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    find_clear_bodies(Motion(x_t0, x_t1));
    cover(Motion(x_t0, x_t1), margin);
  }

  /// Whether cloth could not meet a body when pairs were last collected, and cannot as long as they are covered.
  bool is_clear(std::size_t body) const { return clear_[body].sign != 0; }

  /// The pairs of surfaces that are looked at.
  const std::vector<SurfacePair>& wanted() const { return wanted_; }
  /// The hierarchies, with bounds that hold the vertices of every way that is covered.
  BroadPhase& hierarchies() { return broad_phase_; }
  const BroadPhase& hierarchies() const { return broad_phase_; }

  /// From now on nothing is covered.
  void drop() { margin_ = -1; }

  /// Lets go, between two steps, of what only makes the search faster and does not follow from positions.
  void forget();

  /// What the pairs were collected for: collected for it again, they are the same.
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
  double reach_;
  BroadPhase broad_phase_;
  std::vector<SurfacePair> wanted_;
  CandidatePairs pairs_;
  // What they are good for: starts and ends of vertices no farther than the margin from here [m].
  std::vector<Vec3> from_, low_, high_;  // the last one only where it is another than the one before
  double margin_ = -1;                   // negative: there are none
  /// Half of space without cloth: where sign · x[axis] >= from. Both ends of a way in it, all of the way is.
  struct HalfSpace {
    int axis = 0;
    double sign = 0;                                        // ±1; 0: there is none
    double from = std::numeric_limits<double>::infinity();  // [m]
    bool holds(const Vec3& x) const { return sign * x[axis] >= from; }
  };
  std::vector<HalfSpace> clear_;  // per body: one that holds it
};

}  // namespace weft::collision
