// The inside of an obstacle, and exits from it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/untangle/problem.hpp"

namespace weft::untangle {

/// The region where cloth may not be: inside a body of closed shells, which may cross each other; below a floor; or
/// behind worn cloth (a layer). Points whose nearest point of the layer is on its border are not behind it. Does not
/// move.
class Solid {
 public:
  /// Body `number` of the broad phase at x [m]; both must outlive it.
  Solid(const collision::BroadPhase& surfaces, std::size_t number, Kind kind, std::span<const Vec3> x);
  /// A layer: cloth that is worn over the bodies `below`, or around its own centre if there are none. Its outer side is
  /// the one that mostly faces away from them. `on_border`: per vertex; must outlive it.
  Solid(const collision::BroadPhase& surfaces, std::size_t number, std::span<const Vec3> x,
        std::span<const std::uint8_t> on_border, std::span<const Solid> below);

  std::size_t number() const { return number_; }
  /// Whether p lies in the bounds of the solid or within `distance` [m] of them.
  bool is_near(const Vec3& p, double distance) const;
  /// Whether p is inside. For a body by the winding number, so points where its shells overlap are inside.
  bool inside(const Vec3& p) const;

  /// The nearest point of the outer surface. Faces buried in another shell do not count.
  struct Exit {
    Vec3 place, normal;  ///< the point [m], and the unit normal there, outward
    double height;       ///< signed distance of p [m], negative inside
  };
  Exit exit(const Vec3& p) const;
  /// Distance from p, which is inside, along the unit direction d to the end of the solid [m]; infinite if the ray
  /// stays in a floor or layer.
  double distance_out(const Vec3& p, const Vec3& d) const;
  /// Whether the segment from p to q crosses the surface; false for a floor.
  bool crosses_surface(const Vec3& p, const Vec3& q) const { return kind_ != Kind::floor && !hits(p, q - p).empty(); }
  /// Depth of the segment's midpoint inside the solid, divided by the length of the segment; 0 outside. For a chord of
  /// a circle: 0.21 if it spans a quarter turn, 0.5 if it spans half a turn.
  double midpoint_depth(const Vec3& p, const Vec3& q) const;

 private:
  struct Hit {
    double fraction;  // fraction of the segment
    int winding;      // +1 into the body, −1 out of it
  };
  std::vector<Hit> hits(const Vec3& p, const Vec3& way) const;
  Exit exit_of_layer(const Vec3& p) const;

  const collision::BroadPhase& surfaces_;
  std::size_t number_;
  Kind kind_;
  std::span<const Vec3> x_;
  Box3 box_;
  Vec3 normal_ = Vec3::UnitZ(), place_ = Vec3::Zero();  // of a floor
  std::vector<std::uint8_t> buried_;                    // per triangle: inside another shell
  std::span<const std::uint8_t> on_border_;             // of a layer, per vertex
  int outer_sign_ = 1;                                  // of a layer: −1 if its back is its outer side
};

}  // namespace weft::untangle
