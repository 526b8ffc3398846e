// Finds regions of a surface so flat that no two features inside, without a common vertex, can be near each other.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/collision/hierarchy/traversal.hpp"
#include "physics/collision/hierarchy/tree.hpp"

namespace weft::collision {

/// Computes the normal cones of a tree's nodes and leaves bottom-up, and the flat regions that follow from them.
///
/// Let P be the triangles below a node and P⁺ all triangles that share a vertex with P. Features of P without a common
/// vertex are not near each other if an axis a exists such that, during the linear motion from x_t0 to x_t1,
///   1. no corner of P is on the border of the surface, so the triangles around it, all in P⁺, surround it completely;
///   2. the normals of P⁺ lie in a cone around a with a half-angle below 90°, so that a viewer who looks along −a sees
///      only front sides of P⁺;
///   3. the contour of P⁺, seen along −a, runs counter-clockwise around its centre once (star-shaped: Schvartzman,
///      Pérez & Otaduy, "Star-Contours for Efficient Hierarchical Self-Collision Detection", 2010);
///   4. the altitudes of the triangles of P⁺, projected along a, exceed the detection distance.
///
/// Proof: by condition 2, all projected triangles have the same orientation, so the winding number of the contour
/// around a point is the number of triangles that cover the point. By condition 3, this number is 1 inside the contour,
/// so P⁺ projects to a planar triangulation. In that plane, the closest points of two features of P without a common
/// vertex include a vertex v of one of them. By condition 1, the triangles around v surround v. The segment from v to
/// the other feature leaves them through an edge opposite to v, so it is at least as long as an altitude. Distances in
/// space are no smaller than their projections.
///
/// During a step, normals and cross products of edges are quadratic functions of time. The cone test and the contour
/// test therefore use their Bernstein coefficients (Tang, Curtis, Yoon & Manocha, "ICCD", 2009). A degenerate triangle
/// violates condition 2.
///
/// Provot (1997) and Etzmuß et al. (2001) require only condition 2, for P instead of P⁺. Their test would also skip
/// near pairs of parts that overlap in projection (such as a spiral staircase) or that meet across a border or slit. Of
/// the pairs that their test skips, 0.6 to 25 % are near (measured).
template <int K>
class NormalCones {
 public:
  /// Reads the tree, but keeps no reference to it.
  explicit NormalCones(const Tree<K>& tree);

  /// Finds the flat regions for the motion from x_t0 to x_t1 (global arrays, [m]). Features are near if they are closer
  /// than `detection_distance` [m].
  void update(const Tree<K>& tree, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1, double detection_distance);

  const Regions& regions() const { return regions_; }

 private:
  using Ref = typename Tree<K>::Ref;
  class Builder;

  /// All directions within an angle < 90° of a unit axis; cosine ≤ 0 if there is no such cone.
  struct Cone {
    Vec3 axis = Vec3::Zero();
    double cosine = -1, sine = 0;
    double altitude = 0;  ///< [m]; altitude · cosine: lower bound of the projected altitudes during the step
  };

  /// Connectivity of a subtree. Does not depend on positions.
  struct Subtree {
    bool closed = false;                        ///< condition 1 holds
    std::vector<Ref> ring;                      ///< leaves outside the subtree that contain triangles of P⁺
    std::vector<std::array<Index, 2>> contour;  ///< directed edges of P⁺ whose reverse is not in P⁺
  };

  static std::size_t slot(const Tree<K>& tree, Ref ref);
  static Cone join(std::span<const Cone* const> cones);
  void fit_leaf(const typename Tree<K>::Leaf& leaf, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                Cone& cone) const;
  bool has_nothing_near(const Tree<K>& tree, Ref ref, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                        double detection_distance) const;
  void mark_flat_regions(const Tree<K>& tree, Ref ref, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                         double detection_distance);

  std::vector<Subtree> subtrees_;  // nodes, then leaves
  std::vector<Cone> cones_;        // of P alone; nodes, then leaves
  Regions regions_;
};

/// Whether a closed chain of directed edges, seen along −`axis`, runs around its centre exactly once and
/// counter-clockwise, throughout the linear motion. `axis`: unit.
bool is_star_shaped(std::span<const std::array<Index, 2>> contour, const Vec3& axis, std::span<const Vec3> x_t0,
                    std::span<const Vec3> x_t1);

}  // namespace weft::collision
