// Broad phase of a run: one hierarchy per surface. Run-time options select how to refit and traverse.
//
//   BroadPhase broad_phase(surfaces, x, options);      // once; surfaces are numbered as in the span
//   broad_phase.refit(s, x_t0, x_t1, margin);          // each step, each surface that moved
//   broad_phase.self_pairs(s, candidates);             // appends, as often as needed
//   broad_phase.pairs(a, b, candidates);
//
// With any options, the pairs include every two triangles that come closer than 2 · margin on the linear trajectory
// from x_t0 to x_t1. Exceptions: triangles that share two corners or more; without one_shared, triangles that share
// one; with normal_cones, triangles in a region of one surface that is provably flat (NormalCones).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/query.hpp"
#include "physics/collision/hierarchy/surface.hpp"
#include "physics/collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Measured on falling_band and multi_sheet (tests/bench): leaves of 8 instead of 1 make the search 3 times faster, and
/// 8 children instead of 2 save a fifth. Separation lists save at most a tenth. Velocity and normal cones cost at least
/// as much as they save. 18 directions take longer to refit and traverse than 6, but list a quarter fewer candidates.
/// They save 4 to 9 % of the time of broad and narrow phase together, or a fifth if layers are slanted to the axes. 26
/// directions (Etzmuß et al. 2001) list the fewest candidates.
struct BroadPhaseOptions {
  /// Directions of the bounds: 6, 18 or 26. More directions cost more and list fewer pairs. Boxes (6) list every pair
  /// that 18 or 26 directions list.
  int directions = 6;
  /// Children per node, 2 to 8. Changes only the order of the pairs.
  int children = 8;
  /// Maximum number of triangles per leaf, 1 to 8. Changes only the order of the pairs.
  int leaf = 8;
  /// Of two overlapping nodes, descend only into the one with the longer k-DOP side (Etzmuß et al. 2001), not into
  /// both. Changes only the order of the pairs.
  bool open_longer_side = false;
  /// Resume each traversal where the last one stopped. Lists the same pairs, in an order that depends on earlier
  /// traversals.
  bool separation_list = false;
  /// Give the bounds of slow vertices slack (at most an eighth of the margin) and keep them while the vertices stay
  /// inside. Lists all pairs within 2 · margin, and some that bounds without slack would exclude. (Another use of
  /// velocity cones is CoherentDetection, which keeps whole detection results.)
  bool velocity_cones = false;
  /// Skip pairs in regions of a surface that are provably flat enough. Lists all other pairs.
  bool normal_cones = false;
  /// Also list pairs that share one vertex. In smooth cloth they are three times as many as the others.
  bool one_shared = true;
};

class BroadPhase {
 public:
  BroadPhase() = default;

  /// Builds over the surfaces at x (global array, [m]) and fits them there without margin. The triangles must outlive
  /// the broad phase. Throws Error(internal) if an option or index is out of range.
  BroadPhase(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options = {});

  /// As Tree::refit: bounds for this motion, enlarged by margin [m]. The pairs then include all that meet on any motion
  /// whose starts and ends differ from these by vectors no longer than the margin. With 6 directions, the vectors may
  /// be as long as the margin along each axis.
  void refit(std::size_t surface, const Motion& motion, double margin);
  void refit(std::size_t surface, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    refit(surface, {x_t0, x_t1}, margin);
  }

  /// Appends pairs of different triangles of one surface, a < b.
  void self_pairs(std::size_t surface, CandidatePairs& out);

  /// Appends pairs (a of surface a, b of surface b).
  void pairs(std::size_t a, std::size_t b, CandidatePairs& out);

  /// As collision::nearest_triangles and triangles_in_box (query.hpp), for one surface, at positions inside its bounds.
  void nearest_triangles(std::size_t surface, const Vec3& p, const DistanceSq& distance_sq,
                         std::vector<Index>& out) const;
  void triangles_in_box(std::size_t surface, const Vec3& low, const Vec3& high, std::vector<Index>& out) const;

  std::size_t size() const { return surfaces_.size(); }
  const Surface& surface(std::size_t number) const { return surfaces_[number]; }

  /// Whether bounds or the order of the pairs depend on earlier steps.
  static bool remembers(const BroadPhaseOptions& options) { return options.separation_list || options.velocity_cones; }
  /// Makes bounds and order independent of earlier steps.
  void forget();

  /// Interface that hides the number of directions, a template parameter of the trees.
  struct Trees {
    virtual ~Trees() = default;
    virtual void refit(std::size_t surface, const Motion& motion, double margin) = 0;
    virtual void self_pairs(std::size_t surface, CandidatePairs& out) = 0;
    virtual void pairs(std::size_t a, std::size_t b, CandidatePairs& out) = 0;
    virtual void nearest_triangles(std::size_t surface, const Vec3& p, const DistanceSq& distance_sq,
                                   std::vector<Index>& out) const = 0;
    virtual void triangles_in_box(std::size_t surface, const Vec3& low, const Vec3& high,
                                  std::vector<Index>& out) const = 0;
    virtual void forget() = 0;
  };

 private:
  std::vector<Surface> surfaces_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace weft::collision
