// Regions where cloth may not be, and exits from them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// A region where cloth may not be; it does not move. There are three kinds: the inside of a body, whose shells (its
/// connected closed surfaces) may cross each other; the space below a floor; the space behind a layer
/// (SurfaceKind::layer). A point is not behind a layer if the nearest point of the layer is on its
/// border, or on an edge or face whose vertices are all on its border.
class ForbiddenRegion {
 public:
  /// A body or floor with this number in the broad phase at x [m]. `surfaces` and x must outlive this object.
  ForbiddenRegion(const collision::BroadPhase& surfaces, std::size_t number, SurfaceKind kind, std::span<const Vec3> x);
  /// A layer. Its outer side is the one that, on most of its area, faces away from the nearest body
  /// of `below` or, if `below` is empty, from the centre of the layer's bounding box. `on_border`:
  /// per vertex, 1 if it is on a border. `surfaces`, x and `on_border` must outlive this object.
  ForbiddenRegion(const collision::BroadPhase& surfaces, std::size_t number, std::span<const Vec3> x,
                  std::span<const std::uint8_t> on_border, std::span<const ForbiddenRegion> below);

  std::size_t number() const { return number_; }
  /// Whether p is at most `distance` [m] outside of the bounding box of the surface or, for a floor, less than
  /// `distance` above it. If false, p is outside a body or floor by more than `distance`, but may be behind a layer.
  bool is_near(const Vec3& p, double distance) const;
  /// Whether p is inside. Uses the winding number for a body, so that points in several of its shells are inside.
  bool contains(const Vec3& p) const;

  /// The nearest point of the outer surface to a point p. Faces inside of another shell do not belong to the outer
  /// surface.
  struct Exit {
    /// The nearest point [m]; the outward unit vector along the line through this point and p or,
    /// if p is on the surface, the normal of the surface.
    Vec3 place, normal;
    double height;  ///< signed distance of p from `place` [m], negative inside
  };
  Exit find_exit(const Vec3& p) const;
  /// Distance from p, which is inside, along the unit direction d to the point where the ray leaves the region [m];
  /// infinite if the ray does not leave the region, or leaves it through a hole of a body, such as an open sole.
  double distance_out(const Vec3& p, const Vec3& d) const;
  /// Whether the segment from p to q crosses the surface; always false for a floor.
  bool crosses_surface(const Vec3& p, const Vec3& q) const {
    return kind_ != SurfaceKind::floor && !find_hits(p, q - p).empty();
  }
  /// Depth of the midpoint of the segment from p to q inside the region, divided by the length of
  /// the segment; 0 if the midpoint is outside. Examples: 0.21 for a chord of a quarter circle, 0.5
  /// for the diameter of a circle.
  double midpoint_depth(const Vec3& p, const Vec3& q) const;

 private:
  struct Hit {
    double fraction;  // of the segment, from its start to the crossing
    int winding;      // +1 into the region, −1 out of it
  };
  std::vector<Hit> find_hits(const Vec3& p, const Vec3& way) const;
  Exit exit_of_layer(const Vec3& p) const;

  const collision::BroadPhase& surfaces_;
  std::size_t number_;
  SurfaceKind kind_;
  std::span<const Vec3> x_;
  Box3 box_;
  Vec3 normal_ = Vec3::UnitZ(), place_ = Vec3::Zero();  // of a floor
  std::vector<std::uint8_t> is_inside_other_shell_;     // per triangle: whether it is inside another shell
  std::span<const std::uint8_t> on_border_;             // of a layer, per vertex
  int outer_sign_ = 1;                                  // of a layer: −1 if its back is its outer side
};

}  // namespace weft::untangle
