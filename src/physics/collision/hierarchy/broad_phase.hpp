// Broad phase: lists pairs of triangles with overlapping bounds, with one hierarchy per surface.
// Options that are known only at run time select how hierarchies are refitted and traversed.
//
//   BroadPhase broad_phase(surfaces, x, options);      // once; surface s is surfaces[s]
//   broad_phase.refit(s, {x_t0, x_t1}, margin);        // in each step, for each surface that has moved
//   broad_phase.self_pairs(s, candidates);             // appends pairs; as often as needed
//   broad_phase.pairs(a, b, candidates);
//
// Whatever the options, the pairs include every two triangles that come closer than 2 · margin on the linear trajectory
// from x_t0 to x_t1, except:
//   - triangles with two or more common vertices;
//   - without `one_shared`: triangles with one common vertex;
//   - with `normal_cones`: triangles inside a region of one surface that is provably flat (NormalCones).
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

/// Effect of the options on the time of the search, in the scenes of tests/bench/README.md,
/// "Collision heuristics": 8 triangles per leaf instead of 1 make the search 2 to 3 times as fast,
/// and 8 children per node instead of 2 save 6 to 26 % of its time. Separation lists save at most a
/// tenth of the time. Velocity and normal cones cost at least as much as they save. With 18
/// directions instead of 6, about a quarter fewer pairs are listed, but refitting is slower: broad
/// and narrow phase together take 1.0 to 1.1 times as long, or 0.8 times if layers are slanted to
/// the axes. With 26 directions (Etzmuß et al. 2001), the fewest pairs are listed.
struct BroadPhaseOptions {
  /// Directions of the bounds: 6 (boxes), 18 or 26. With more directions, each bound takes more time, and the broad
  /// phase lists fewer pairs, a subset of those of boxes.
  int directions = 6;
  /// Children per node, 2 to 8. Changes only the order of the pairs and, with `normal_cones`, which
  /// pairs are skipped.
  int children = 8;
  /// Maximum number of triangles per leaf, 1 to 8. Changes only the order of the pairs and, with
  /// `normal_cones`, which pairs are skipped.
  int leaf = 8;
  /// Of two nodes that overlap, descend only into the one with the longer k-DOP side (Etzmuß et al. 2001). False:
  /// descend into both. Changes only the order of the pairs.
  bool open_longer_side = false;
  /// Resume each traversal where the last one stopped. Lists the same pairs, in an order that depends on earlier
  /// traversals.
  bool separation_list = false;
  /// Refit lazily (Tree::refit_lazily): the bound of a slow vertex gets a slack of at most an
  /// eighth of the margin and stays unchanged while the vertex stays within the slack. The slack
  /// adds pairs of triangles that are farther apart than 2 · margin. (CoherentDetection has
  /// velocity cones of its own, which do not depend on this option.)
  bool velocity_cones = false;
  /// Skip pairs inside regions of a surface that are provably flat enough (NormalCones).
  bool normal_cones = false;
  /// Also list pairs with one common vertex. In smooth cloth there are three times as many of them as of other pairs.
  bool one_shared = true;
};

class BroadPhase {
 public:
  BroadPhase() = default;

  /// Builds a hierarchy over each surface at x (global array, [m]) and fits it there without
  /// margin. The triangles must outlive the broad phase. Throws Error(internal) if an option or
  /// index is out of range.
  BroadPhase(std::span<const Surface> surfaces, std::span<const Vec3> x, const BroadPhaseOptions& options = {});

  /// As Tree::refit, or with `velocity_cones` as Tree::refit_lazily; `margin` in [m]. Afterwards, self_pairs() and
  /// pairs() list all pairs of triangles that meet on any motion whose starts and ends differ from those of `motion` by
  /// at most the margin: in Euclidean distance or, with 6 directions, along each axis.
  void refit(std::size_t surface, const Motion& motion, double margin) { trees_->refit(surface, motion, margin); }

  /// Appends pairs of different triangles of one surface, a < b.
  void self_pairs(std::size_t surface, CandidatePairs& out) { trees_->self_pairs(surface, out); }

  /// Appends pairs (a of surface a, b of surface b).
  void pairs(std::size_t a, std::size_t b, CandidatePairs& out) { trees_->pairs(a, b, out); }

  /// As collision::nearest_triangles and triangles_in_box (query.hpp) for one surface, at positions inside its bounds.
  void nearest_triangles(std::size_t surface, const Vec3& p, const DistanceSq& distance_sq,
                         std::vector<Index>& out) const {
    trees_->nearest_triangles(surface, p, distance_sq, out);
  }
  void triangles_in_box(std::size_t surface, const Vec3& low, const Vec3& high, std::vector<Index>& out) const {
    trees_->triangles_in_box(surface, low, high, out);
  }

  std::size_t size() const { return surfaces_.size(); }
  const Surface& surface(std::size_t number) const { return surfaces_[number]; }

  /// Whether the bounds or the order of the pairs depend on earlier steps.
  static bool remembers(const BroadPhaseOptions& options) { return options.separation_list || options.velocity_cones; }
  /// Makes the bounds and the order of the pairs independent of earlier steps.
  void forget() { trees_->forget(); }

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
