// The inside of an obstacle, and ways out of it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/broad_phase.hpp"
#include "core/types.hpp"
#include "untangle/problem.hpp"

namespace weft::untangle {

/// A body of closed shells, which may cross each other, or all that is below a plane, or behind cloth that is worn:
/// what that has as its nearest point, and not its border. Does not move.
class Solid {
 public:
  /// Body `number` of the broad phase, which must outlive it, at x [m].
  Solid(const collision::BroadPhase& surfaces, std::size_t number, Kind kind, std::span<const Vec3> x);
  /// Cloth that is worn over what others have inside, or around its own middle where there are none: its outer side is
  /// the one that faces away from that, on the whole. `on_border`: per vertex; must outlive it.
  Solid(const collision::BroadPhase& surfaces, std::size_t number, std::span<const Vec3> x,
        std::span<const std::uint8_t> on_border, std::span<const Solid> below);

  std::size_t number() const { return number_; }
  /// Whether p is near enough to be inside, or within `distance` [m] of it.
  bool reaches(const Vec3& p, double distance) const;
  /// By the winding number: what the shells of a body have in common is inside, whichever of their faces is near.
  bool inside(const Vec3& p) const;

  /// The nearest point of what is seen from outside.
  struct Exit {
    Vec3 place, normal;  ///< normal: outward, unit
    double height;       ///< of p above it [m], negative inside
  };
  Exit exit(const Vec3& p) const;
  /// How far from p, inside, it is along the unit direction d until the body ends [m]; infinite where it does not.
  double way_out(const Vec3& p, const Vec3& d) const;
  /// Whether the straight way between these goes through its surface.
  bool meets(const Vec3& p, const Vec3& q) const { return kind_ != Kind::floor && !hits(p, q - p).empty(); }
  /// How deep the middle of the straight way between these is inside, in its lengths; 0 outside. Over a round body it
  /// is 0.21 after a quarter of a turn, and 0.5 after a half.
  double depth_between(const Vec3& p, const Vec3& q) const;

 private:
  struct Hit {
    double at;  // in lengths of the way
    int turn;   // +1 into the body, −1 out of it
  };
  std::vector<Hit> hits(const Vec3& p, const Vec3& way) const;
  Exit exit_of_layer(const Vec3& p) const;

  const collision::BroadPhase& surfaces_;
  std::size_t number_;
  Kind kind_;
  std::span<const Vec3> x_;
  Box3 box_;
  Vec3 normal_ = Vec3::UnitZ(), place_ = Vec3::Zero();  // of a floor
  std::vector<std::uint8_t> buried_;                    // per triangle: another shell hides it
  std::span<const std::uint8_t> on_border_;             // of a layer, per vertex
  int outer_ = 1;                                       // of a layer: −1 where its back is its outer side
};

}  // namespace weft::untangle
