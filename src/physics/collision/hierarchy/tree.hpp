// Bounding volume hierarchy over the triangles of one surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/kdop.hpp"
#include "physics/collision/hierarchy/lanes.hpp"
#include "physics/collision/hierarchy/surface.hpp"

namespace weft::collision {

/// Motion of all vertices [m]: vertex v moves from x_t0[v] to any point of the box from low_t1[v] to high_t1[v]. The
/// box may be a single point.
struct Motion {
  std::span<const Vec3> x_t0, low_t1, high_t1;

  Motion(std::span<const Vec3> start, std::span<const Vec3> low, std::span<const Vec3> high)
      : x_t0(start), low_t1(low), high_t1(high) {}
  /// Motion of each vertex to one end position. For a surface at rest, pass the same positions twice.
  Motion(std::span<const Vec3> start, std::span<const Vec3> end) : Motion(start, end, end) {}
};

/// Maximum number of children per node and of triangles per leaf. Each child or triangle takes one lane (lanes.hpp).
struct TreeShape {
  int children = kLanes;  ///< 2 to 8
  int leaf = kLanes;      ///< 1 to 8
};

/// A tree of k-DOPs. The bounds of a node's children, and of a leaf's triangles, are stored side by side, so that one
/// SIMD operation tests all of them; smaller nodes leave lanes empty. Nodes are numbered depth first, parents before
/// children, so refitting is one pass from the last node to the first.
template <int K>
class Tree {
 public:
  using Bound = MovingKDop<K>;

  /// A child or the root: node number (≥ 0) or ~leaf number (< 0).
  using Ref = std::int32_t;

  struct Node {
    LaneBounds<K> bounds;
    Ref child[kLanes];
    std::int32_t count = 0;  ///< children in use
  };

  struct Leaf {
    LaneBounds<K> bounds;
    LaneCorners corners;
    std::int32_t triangle[kLanes];  ///< global numbers
    std::int32_t count = 0;
  };

  Tree() = default;

  /// Builds a tree over the surface at `positions` (global array, [m]) and fits it there without margin. Splits sets of
  /// triangles by split_longest_side() until each set fits into a leaf. Throws Error(internal) if an index or the shape
  /// is out of range.
  Tree(const Surface& surface, std::span<const Vec3> positions, const TreeShape& shape = {});

  /// Fits all bounds to linear motion, enlarged by `margin` [m] in every direction at both ends. Triangles that come
  /// closer than 2 · margin at any time of the motion then have overlapping bounds.
  void refit(const Motion& motion, double margin);

  /// As refit, but enlarges the bound of a slow vertex by a slack that suffices for a few steps (see kMaxSlackFraction
  /// in tree.cpp), and keeps this bound while the vertex stays within the slack. Refits only leaves and nodes above
  /// vertices with a new bound. If the margin has changed, renews all bounds. Bounds are never smaller than after
  /// refit.
  void refit_lazily(const Motion& motion, double margin);

  /// Makes the next lazy refit renew all bounds.
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

  /// A vertex bound holds while the vertex is within `slack` [m] of `place`; slack < 0: the bound has no slack.
  struct VertexSlack {
    Vec3 place = Vec3::Zero();
    double slack = -1;
  };

  bool update_vertex_bound(std::size_t v, const Vec3& p, const Vec3& low, const Vec3& high, double margin);
  void fit_leaf(std::size_t n);
  void fit_node(std::size_t n);

  Surface surface_;
  Ref root_ = 0;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<Bound> node_bounds_, leaf_bounds_;
  std::vector<Bound> vertex_bounds_;  ///< per vertex: bound of its trajectory; only lazy refits reuse it

  // Used only by lazy refits.
  std::vector<VertexSlack> vertex_slacks_;            // by vertex
  std::vector<std::uint8_t> moved_;                   // by vertex: has a new bound
  std::vector<std::uint8_t> changed_, leaf_changed_;  // by node, by leaf: has a new bound
  double resting_margin_ = -1;                        // margin of the bounds with slack [m]
};

}  // namespace weft::collision
