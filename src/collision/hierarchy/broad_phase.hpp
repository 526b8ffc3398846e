// The broad phase of a run: a hierarchy for each surface, and how they are kept and walked, chosen at run time.
//
//   BroadPhase broad_phase(surfaces, x, options);      // once; surfaces are then named by their place in the span
//   broad_phase.refit(s, x_t0, x_t1, margin);          // each step, each surface that moved
//   broad_phase.self_pairs(s, candidates);             // appends, as often as needed
//   broad_phase.pairs(a, b, candidates);
//
// Whatever the options, every two triangles that come closer than 2 · margin anywhere on the linear way from x_t0 to
// x_t1 are among the pairs, except those sharing two corners or more, and, with normal_cones, pairs of one surface in
// which no two features without a common vertex come closer than 2 · margin.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "collision/hierarchy/query.hpp"
#include "collision/hierarchy/surface.hpp"
#include "collision/hierarchy/tree.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// The defaults walk fastest on falling_band and multi_sheet (measured with tests/bench): leaves of 8 instead of 1 are
/// worth a factor of 3, 8 children instead of 2 a fifth, separation lists a tenth at most; velocity and normal cones
/// cost what they save or more. k = 18 walks and refits longer but lists a quarter fewer candidates: with the search
/// for proximities 4 to 9 % less in all, a fifth less where layers lie slanted to the axes. k = 26, the seed's, lists
/// the fewest; k = 14 was worse than 6 or 18 in every measurement.
struct BroadPhaseOptions {
  /// Directions of the bounds: 6, 18 or 26. More of them list fewer pairs and cost more (fewest: all pairs that 26-DOPs
  /// list are also listed by boxes).
  int directions = 6;
  /// Children per node, 2 to 8. Changes the order of the pairs only.
  int children = 8;
  /// Most triangles per leaf, 1 to 8. Changes the order of the pairs only.
  int leaf = 8;
  /// Of two overlapping nodes open the one with the longer k-DOP side, as the seed does, instead of both. Changes the
  /// order of the pairs only.
  bool open_longer_side = false;
  /// Walk on from where the last walk stopped. Lists exactly the same pairs; their order depends on the walks before.
  bool separation_list = false;
  /// Bounds of slow vertices get slack (an eighth of the margin at most) and are left as they are while the vertices
  /// stay inside. Lists all pairs within 2 · margin, and some that the bounds without slack would drop. To reuse whole
  /// detection results by velocity cones see collision/proximity/coherence.hpp.
  bool velocity_cones = false;
  /// Leaves out pairs in regions of a surface that are provably flat enough. Lists all other pairs.
  bool normal_cones = false;
  /// Pairs that share one vertex are listed, too. In smooth cloth they are three times as many as the others, and all
  /// are known beforehand.
  bool one_shared = true;
};

class BroadPhase {
 public:
  BroadPhase() = default;

  /// Builds over the surfaces at x (global array, [m]) and fits them there without margin; the triangles must outlive
  /// the broad phase. Throws Error(internal) for options or indices out of range.
  BroadPhase(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options = {});

  /// As Tree::refit: bounds for this motion, enlarged by margin [m]. Pairs hold for every other one, too, whose ends
  /// are no farther than that from those, along any axis.
  void refit(std::size_t surface, const Motion& motion, double margin);
  void refit(std::size_t surface, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    refit(surface, {x_t0, x_t1}, margin);
  }

  /// Appends pairs of different triangles of one surface, a < b.
  void self_pairs(std::size_t surface, CandidatePairs& out);

  /// Appends pairs (a of surface a, b of surface b).
  void pairs(std::size_t a, std::size_t b, CandidatePairs& out);

  /// As collision::nearest_triangles and triangles_in_box (query.hpp), of one surface anywhere on the way that its
  /// bounds were last fitted to.
  void nearest_triangles(std::size_t surface, const Vec3& p, const DistanceSq& distance_sq,
                         std::vector<Index>& out) const;
  void triangles_in_box(std::size_t surface, const Vec3& low, const Vec3& high, std::vector<Index>& out) const;

  std::size_t size() const { return surfaces_.size(); }
  const Surface& surface(std::size_t number) const { return surfaces_[number]; }

  /// Whether bounds and the order of the pairs depend on the steps before.
  static bool remembers(const BroadPhaseOptions& options) { return options.separation_list || options.velocity_cones; }
  /// From here on they no longer do.
  void forget();

  /// One kind of tree; the only place that knows its type.
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
