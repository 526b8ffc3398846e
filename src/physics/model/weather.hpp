// Gravity, and the velocity of the air, at any time and place.
#pragma once

#include <optional>
#include <vector>

#include "core/archive.hpp"
#include "physics/model/gusts.hpp"
#include "physics/model/model.hpp"
#include "physics/motion/spline.hpp"

namespace weft::model {

/// Gravity is the same everywhere. The velocity of the air is the sum of wind, gusts and fans. If
/// Model::air_acts() is false, gusts and fans are left out. The wind displaces the field of gusts by the integral of
/// its velocity over time.
///
/// A fan moves air through its outlet disc into a cone, whose apex is radius / tan(angle / 2)
/// behind the disc. In front of the disc, the fan adds a velocity away from the apex, of magnitude
///
///     u = speed · (a / s)^falloff · (1 − q²)²,
///
/// where s and a are the distances of the point and of the disc from the apex along the axis, and q
/// is the distance of the point from the axis, relative to the radius of the cone at s. A free
/// round jet has an opening angle of about 24 degrees, and its speed falls as 1 / s (Pope,
/// Turbulent Flows, 2000, section 5.1). (1 − q²)² approximates the jet's profile and falls to 0
/// with zero slope at the edge of the cone. Behind the disc and outside the cone, the fan adds no
/// velocity.
class Weather {
 public:
  explicit Weather(const Model& model);

  /// Gravity at time t [s], in [m/s²].
  Vec3 gravity(double t) const { return keys_ ? Vec3(keys_->at(t).value.head<3>()) : gravity_; }
  /// Whether there are gusts, fans, or key frames of gravity and wind. If not, the velocity of the air is
  /// Model::physics.wind at all times and places.
  bool differs_from_wind() const { return keys_.has_value() || gusts_.has_value() || !fans_.empty(); }
  /// Velocity of the air at x [m] and time t [s], in [m/s].
  Vec3 air(const Vec3& x, double t) const;
  /// Whether gravity and air are the same at t0 and t1 [s]; false if there are gusts.
  bool is_constant_between(double t0, double t1) const;

  /// Displacement of the gusts up to t [s] in addition to that by Model::physics.wind since time 0 [m]; 0 without keys.
  Vec3 gust_displacement(double t) const;
  /// Shifts gusts so that this displacement is `displacement` at t [s]: other keys would make them jump.
  void set_gust_displacement(double t, const Vec3& displacement) { shift_ += displacement - gust_displacement(t); }
  /// Saves or restores this shift.
  template <class Archive>
  void serialize(Archive& archive) {
    archive.raw(shift_.data(), 3 * sizeof(double));
    if constexpr (Archive::kReads) require(shift_.allFinite(), "a displacement of gusts");
  }

 private:
  struct Fan {
    motion::Spline<7> track;  // position of the disc, direction, speed
    double slope;             // tangent of half the opening angle
    double apex;              // distance of the apex behind the disc [m]
    double falloff;

    Vec3 air(const Vec3& x, double t) const;
  };
  Vec3 gravity_, wind_;
  std::optional<motion::Spline<6>> keys_;    // gravity and wind
  std::optional<motion::Spline<3>> excess_;  // wind of the keys minus wind_
  Vec3 shift_ = Vec3::Zero();                // part of gust_displacement() that the keys do not give [m]
  std::optional<GustField> gusts_;
  std::vector<Fan> fans_;
};

}  // namespace weft::model
