// Gravity and the velocity of the air at any time and place.
#pragma once

#include <optional>
#include <vector>

#include "environment/gusts.hpp"
#include "environment/spline.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// Gravity is the same everywhere. The velocity of the air is the sum of wind, gusts and fans.
///
/// A fan blows in a cone that its disc cuts: the apex is radius / tan(angle / 2) behind the disc. In front of the disc
/// the air moves away from the apex, with
///
///     u = speed (a / s)^falloff (1 − q²)²,
///
/// s and a: distances along the axis of the place and of the disc from the apex; q: distance from the axis over the
/// radius of the cone there. A free round jet opens by about 24 degrees, and its speed falls as 1 / s (Pope, Turbulent
/// Flows, 2000, section 5.1); (1 − q²)² is its profile but for the edge, where it is 0 with zero slope. Behind the disc
/// and beside the cone the air rests.
class Weather {
 public:
  explicit Weather(const scene::Scene& scene);

  /// At time t [s], in [m/s²].
  Vec3 gravity(double t) const { return keys_ ? Vec3(keys_->at(t).value.head<3>()) : gravity_; }
  /// Whether the air moves otherwise than with scene.physics.wind alone.
  bool is_local() const { return keys_.has_value() || gusts_.has_value() || !fans_.empty(); }
  /// Velocity of the air at x [m] and time t [s], in [m/s].
  Vec3 air(const Vec3& x, double t) const;
  /// Whether all of it is the same at both times [s].
  bool stays(double t0, double t1) const;

 private:
  struct Fan {
    Spline<7> track;  // position, direction, speed
    double slope;     // tangent of half the angle
    double apex;      // distance of the apex behind the disc [m]
    double falloff;

    Vec3 air(const Vec3& x, double t) const;
  };
  Vec3 gravity_, wind_;
  std::optional<Spline<6>> keys_;  // gravity, wind
  std::optional<Gusts> gusts_;
  std::vector<Fan> fans_;
};

/// Whether the air acts on any cloth of the scene.
bool air_acts(const scene::Scene& scene);
/// Whether it does, and has gusts.
bool blows_in_gusts(const scene::Scene& scene);

}  // namespace weft::environment
