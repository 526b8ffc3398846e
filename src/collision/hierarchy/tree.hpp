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

/// Where vertices go, by global number [m]: from x_t0 to anywhere in the box between two corners, which may be one.
struct Motion {
  std::span<const Vec3> x_t0, low_t1, high_t1;

  Motion(std::span<const Vec3> start, std::span<const Vec3> low, std::span<const Vec3> high)
      : x_t0(start), low_t1(low), high_t1(high) {}
  /// To one place each; the same twice for a still surface.
  Motion(std::span<const Vec3> start, std::span<const Vec3> end) : Motion(start, end, end) {}
};

/// How many children a node and how many triangles a leaf has at most, one per lane.
struct TreeShape {
  int children = kLanes;  ///< 2 to 8
  int leaf = kLanes;      ///< 1 to 8
};

/// A tree of k-DOPs. The bounds of a node's children, and of a leaf's triangles, lie side by side so that all are
/// tested at once; a shape with fewer of them leaves lanes empty. Nodes are numbered depth first, parents before
/// children: refitting is one pass from the last to the first.
template <int K>
class Tree {
 public:
  using Bound = MovingKDop<K>;

  /// A child or the root: a node (≥ 0) or leaf ~ref (< 0).
  using Ref = std::int32_t;

  struct Node {
    LaneBounds<K> bounds;
    Ref child[kLanes];
    std::int32_t count = 0;  ///< children used
  };

  struct Leaf {
    LaneBounds<K> bounds;
    LaneCorners corners;
    std::int32_t triangle[kLanes];  ///< global numbers
    std::int32_t count = 0;
  };

  Tree() = default;

  /// Builds over the surface at `positions` (global array, [m]) and fits it there without margin. Split by the longest
  /// side until the triangles left fit into a leaf. Throws Error(internal) where an index or the shape is out of range.
  Tree(const Surface& surface, std::span<const Vec3> positions, const TreeShape& shape = {});

  /// Fits all bounds to linear motion, enlarged by `margin` [m] in every direction at both ends. With margin ε/2 on
  /// both sides, triangles that come closer than ε at any time of the motion have overlapping bounds (seed, "Bounding
  /// Volume Hierarchy").
  void refit(const Motion& motion, double margin);
  void refit(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) { refit({x_t0, x_t1}, margin); }

  /// As refit, but only where something left the bounds it has: vertices that move little get bounds that hold for a
  /// few steps ahead (see kSlackPart in tree.cpp), and nodes below which every vertex is still inside its own are left
  /// as they are. Bounds are never smaller than after refit.
  void refit_lazily(const Motion& motion, double margin);
  void refit_lazily(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double margin) {
    refit_lazily({x_t0, x_t1}, margin);
  }

  /// Makes the next lazy refit give all bounds anew.
  void forget() { resting_margin_ = -1; }

  bool empty() const { return leaves_.empty(); }
  const Surface& surface() const { return surface_; }
  Ref root() const { return root_; }
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const Leaf> leaves() const { return leaves_; }

  /// Bound of a node or leaf as a whole.
  const Bound& bound(Ref ref) const { return ref >= 0 ? node_bounds_[ref] : leaf_bounds_[~ref]; }

 private:
  struct Builder;

  /// Where a vertex may be without leaving its bound: within `slack` [m] of `place`; nowhere where slack < 0.
  struct Resting {
    Vec3 place = Vec3::Zero();
    double slack = -1;
  };

  bool stay_or_move(std::size_t v, const Vec3& p, const Vec3& low, const Vec3& high, double margin);
  void fit(std::size_t n);
  void fit_node(std::size_t n);

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

}  // namespace weft::collision
