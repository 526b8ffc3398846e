#include "physics/model/weather.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace weft::model {

Weather::Weather(const Model& model) : gravity_(model.physics.gravity), wind_(model.physics.wind) {
  if (!model.physics.keys.empty()) {
    std::vector<double> times;
    std::vector<motion::Spline<6>::Value> values;
    std::vector<Vec3> excesses;
    for (const PhysicsKey& key : model.physics.keys) {
      times.push_back(key.time);
      values.push_back((motion::Spline<6>::Value() << key.gravity, key.wind).finished());
      excesses.push_back(key.wind - wind_);
    }
    keys_.emplace(model.physics.interpolation, times, std::move(values));
    excess_.emplace(model.physics.interpolation, std::move(times), std::move(excesses));
  }
  if (!model.air_acts()) return;
  // The field moves with Physics::wind; gust_displacement() is the rest of its motion.
  if (model.physics.gusts.speed > 0) gusts_.emplace(model.physics.gusts, model.physics.wind);
  for (const model::Fan& fan : model.fans) {
    std::vector<double> times;
    std::vector<motion::Spline<7>::Value> values;
    for (const FanKey& key : fan.keys) {
      times.push_back(key.time);
      values.push_back((motion::Spline<7>::Value() << key.position, key.direction.normalized(), key.speed).finished());
    }
    const double slope = std::tan(fan.angle * std::numbers::pi / 360);
    fans_.push_back({{fan.interpolation, std::move(times), std::move(values)}, slope, fan.radius / slope, fan.falloff});
  }
}

Vec3 Weather::Fan::air(const Vec3& x, double t) const {
  const motion::Spline<7>::Value now = track.at(t).value;
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
  if (gusts_) sum += gusts_->at(x - gust_displacement(t), t);
  for (const Fan& fan : fans_) sum += fan.air(x, t);
  return sum;
}

Vec3 Weather::gust_displacement(double t) const {
  return excess_ ? Vec3(shift_ + excess_->integral(0, t)) : shift_;
}

bool Weather::is_constant_between(double t0, double t1) const {
  if (gusts_ || (keys_ && keys_->at(t0).value != keys_->at(t1).value)) return false;
  return std::ranges::all_of(fans_, [&](const Fan& fan) { return fan.track.at(t0).value == fan.track.at(t1).value; });
}

}  // namespace weft::model
