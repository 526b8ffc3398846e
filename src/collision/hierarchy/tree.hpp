// Bounding volume hierarchy over the triangles of one surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/kdop.hpp"
#include "collision/hierarchy/lanes.hpp"
#include "collision/hierarchy/surface.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// Most triangles a leaf can hold: one per AVX lane.
inline constexpr int kLeafLanes = 8;

/// A tree of k-DOPs with up to `Arity` (2, 4 or 8) children per node and up to eight triangles per leaf. The bounds of
/// a node's children, and of a leaf's triangles, lie side by side so that all are tested at once. Nodes are numbered
/// depth first, parents before children: refitting is one pass from the last to the first.
template <int K, int Arity>
class Tree {
 public:
  using Bound = KDop<K>;

  /// A child or the root: a node (≥ 0) or leaf ~ref (< 0).
  using Ref = std::int32_t;

  struct Node {
    LaneBounds<K, Arity> bounds;
    Ref child[Arity];
    std::int32_t count = 0;  ///< children used
  };

  struct Leaf {
    LaneBounds<K, kLeafLanes> bounds;
    LaneCorners corners;
    std::int32_t triangle[kLeafLanes];  ///< global numbers
    std::int32_t count = 0;
  };

  Tree() = default;

  /// Builds over the surface at `positions` (global array, [m]) and fits it there without margin. Split by the longest
  /// side until at most leaf_capacity (1 to 8) triangles are left. Throws Error(internal) where an index is out of
  /// range.
  Tree(const Surface& surface, std::span<const Vec3> positions, int leaf_capacity = kLeafLanes);

  /// Fits all bounds to the linear motion from x_t0 to x_t1 (global arrays, [m]; the same twice for a still surface),
  /// enlarged by `margin` [m] in every direction. With margin ε/2 on both sides, triangles that come closer than ε at
  /// any time of the motion have overlapping bounds (seed, "Bounding Volume Hierarchy").
  void refit(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin);

  /// As refit, but only where something left the bounds it has: vertices that move little get bounds that hold for a
  /// few steps ahead (see kSlackPart in tree.cpp), and nodes below which every vertex is still inside its own are left
  /// as they are. Bounds are never smaller than after refit.
  void refit_lazily(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin);

  /// Makes the next lazy refit give all bounds anew.
  void forget() { resting_margin_ = -1; }

  bool empty() const { return leaves_.empty(); }
  const Surface& surface() const { return surface_; }
  Ref root() const { return root_; }
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const Leaf> leaves() const { return leaves_; }

  /// Bound of a node or leaf as a whole.
  const Bound& bound(Ref ref) const {
    return ref >= 0 ? node_bounds_[static_cast<std::size_t>(ref)] : leaf_bounds_[static_cast<std::size_t>(~ref)];
  }

 private:
  struct Builder;

  /// Where a vertex may be without leaving its bound: within `slack` [m] of `place`; nowhere where slack < 0.
  struct Resting {
    Vec3 place = Vec3::Zero();
    double slack = -1;
  };

  bool stay_or_move(std::size_t v, const Vec3& p, const Vec3& q, double margin);
  void fit(std::size_t leaf);
  void fit_node(std::size_t node);

  Surface surface_;
  Ref root_ = 0;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<Bound> node_bounds_, leaf_bounds_;
  std::vector<Bound> vertex_bounds_;  ///< path of each vertex of the surface; kept between lazy refits only

  // Of lazy refits only.
  std::vector<Resting> resting_;                      // by vertex
  std::vector<std::uint8_t> moved_;                   // by vertex: has another bound than before
  std::vector<std::uint8_t> changed_, leaf_changed_;  // by node, by leaf
  double resting_margin_ = -1;                        // margin that the resting bounds have [m]
};

/// The tree of the simulation. Measured with tests/bench/collision.cpp, refit + self pairs in CPU ms on one core,
/// sheets of 64×64 particles flat / in 8 layers: boxes 8-ary 0.44 / 0.81, 4-ary 0.43 / 0.83, 2-ary 0.51 / 0.97; 14-DOPs
/// 8-ary 0.61 / 2.6, 18-DOPs 0.72 / 3.0, 26-DOPs 1.27 / 3.8; leaves of 4 instead of 8 take 20 to 80 % longer. More
/// directions drop up to 43 % of the pairs between layers but cost more than the pairs saved, in part because the
/// longest side of a sheet is then its diagonal, and halves cut along it have worse bounds.
using SurfaceTree = Tree<6, 8>;

}  // namespace weft::collision
