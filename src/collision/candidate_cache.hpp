// Which pairs of triangles can meet, and for how long that holds.
#pragma once

#include <cstddef>
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

/// Pairs are collected for the way of all vertices from x_t0 to x_t1, with bounds enlarged by a margin. They hold for
/// every other way whose ends are inside those bounds, and what was near the reach then tells who can be within it
/// while no vertex has left its start by more than the rest of the margin: cloth at rest is searched once.
class CandidateCache {
 public:
  /// `bodies` must outlive it. `x`: all vertices at the start [m]; `reach`: distance below which features are near [m].
  CandidateCache(const Bodies& bodies, const SearchParameters& parameters, std::span<const Vec3> x, double reach);

  /// All pairs of triangles that can come within the reach on the way from x_t0 to x_t1, and from now on the bounds
  /// that covers_start() and covers_end() speak of. Who asked may thin them out.
  CandidatePairs& collect(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Where collect() lists them.
  CandidatePairs& pairs() { return pairs_; }

  /// Distance at the start of the collection below which features are that can be within the reach at an x_t0 that is
  /// covered [m].
  double radius() const { return 2 * margin_; }
  double reach() const { return reach_; }

  /// Whether features that are within the reach at x were within the radius when the pairs were collected.
  bool covers_start(std::span<const Vec3> x) const;
  /// Whether x is inside the bounds: the pairs hold all that can meet on a way that ends there.
  bool covers_end(std::span<const Vec3> x) const;

  /// For who collects by other means: pairs hold for ways within `margin` [m] of the one from x_t0 to x_t1.
  void cover(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin);

  /// The pairs of surfaces that are looked at.
  const std::vector<SurfacePair>& wanted() const { return wanted_; }
  /// The hierarchies, with bounds that hold the vertices of every way that is covered.
  BroadPhase& hierarchies() { return broad_phase_; }
  const BroadPhase& hierarchies() const { return broad_phase_; }

  /// From now on nothing is covered.
  void drop() { margin_ = -1; }

  /// Lets go, between two steps, of what only makes the search faster and does not follow from positions.
  void forget();

  /// The positions that the pairs were collected for: collected for them again, they are the same.
  std::span<const Vec3> from() const { return from_; }
  std::span<const Vec3> to() const { return to_; }

 private:
  void refit(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin);

  const Bodies& bodies_;
  SearchParameters parameters_;
  double reach_;
  BroadPhase broad_phase_;
  std::vector<SurfacePair> wanted_;
  CandidatePairs pairs_;
  // What they are good for: vertices between these positions, or no further from there than the margin [m].
  std::vector<Vec3> from_, to_;
  double margin_ = -1;  // negative: there are none
};

}  // namespace weft::collision
