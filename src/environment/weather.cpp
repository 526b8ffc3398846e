#include "environment/weather.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::environment {

bool air_acts(const scene::Scene& scene) {
  return scene.physics.air_density > 0 &&
         std::ranges::any_of(scene.cloths, [](const scene::Cloth& cloth) { return cloth.material.drag > 0; });
}

bool has_gusts(const scene::Scene& scene) {
  return scene.physics.gusts.speed > 0 && air_acts(scene);
}

Weather::Weather(const scene::Scene& scene) : gravity_(scene.physics.gravity), wind_(scene.physics.wind) {
  if (!scene.physics.keys.empty()) {
    std::vector<double> times;
    std::vector<Spline<6>::Value> values;
    for (const scene::PhysicsKey& key : scene.physics.keys) {
      times.push_back(key.time);
      values.push_back((Spline<6>::Value() << key.gravity, key.wind).finished());
    }
    keys_.emplace(scene.physics.interpolation, std::move(times), std::move(values));
  }
  if (!air_acts(scene)) return;
  // Keyed wind carries the gusts with its velocity at the start.
  if (has_gusts(scene)) gusts_.emplace(scene.physics.gusts, scene.physics.wind);
  for (const scene::Fan& fan : scene.fans) {
    std::vector<double> times;
    std::vector<Spline<7>::Value> values;
    for (const scene::FanKey& key : fan.keys) {
      times.push_back(key.time);
      values.push_back((Spline<7>::Value() << key.position, key.direction.normalized(), key.speed).finished());
    }
    const double slope = std::tan(fan.angle * std::numbers::pi / 360);
    fans_.push_back({{fan.interpolation, std::move(times), std::move(values)}, slope, fan.radius / slope, fan.falloff});
  }
}

Vec3 Weather::Fan::air(const Vec3& x, double t) const {
  const Spline<7>::Value now = track.at(t).value;
  const Vec3 axis = now.segment<3>(3).normalized();
  const Vec3 from_apex = x - Vec3(now.head<3>()) + apex * axis;
  const double along = from_apex.dot(axis);
  if (along < apex) return Vec3::Zero();
  const double q_sq = (from_apex - along * axis).squaredNorm() / (slope * slope * along * along);
  if (q_sq >= 1) return Vec3::Zero();
  const double speed = now[6] * std::pow(apex / along, falloff) * (1 - q_sq) * (1 - q_sq);
  return speed / from_apex.norm() * from_apex;
}

Vec3 Weather::air(const Vec3& x, double t) const {
  Vec3 sum = keys_ ? Vec3(keys_->at(t).value.tail<3>()) : wind_;
  if (gusts_) sum += gusts_->at(x, t);
  for (const Fan& fan : fans_) sum += fan.air(x, t);
  return sum;
}

bool Weather::is_constant_between(double t0, double t1) const {
  if (gusts_ || (keys_ && keys_->at(t0).value != keys_->at(t1).value)) return false;
  return std::ranges::all_of(fans_, [&](const Fan& fan) { return fan.track.at(t0).value == fan.track.at(t1).value; });
}

}  // namespace weft::environment
