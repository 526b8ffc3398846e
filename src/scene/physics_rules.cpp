#include "scene/physics_rules.hpp"

#include "scene/common_rules.hpp"
#include "scene/physics.hpp"
#include "scene/table_builder.hpp"

namespace weft::scene {
namespace {

const Range kGravity = within(-1e5, 1e5);  // [m/s²]
const Range kWind = within(-1000, 1000);   // [m/s]

const Table& gust_rules() {
  static const Table kTable =
      TableBuilder<Gusts>("Turbulence of the air: eddies that the wind carries along, the same in every run.")
          .number("speed", &Gusts::speed, within(0, 1000), "m/s",
                  "root mean square of each component beside the wind; 0 for none")
          .number("size", &Gusts::size, above(0, 1e5), "m", "of the eddies that carry most (integral length)")
          .whole_number("seed", &Gusts::seed, within(0, 1e9), "another one gives other gusts")
          .build();
  return kTable;
}

const Table& physics_key_rules() {
  static const Table kTable = TableBuilder<PhysicsKey>("Gravity and wind at a time.")
                                  .number("time", &PhysicsKey::time, kMoment, "s", "later than the key before")
                                  .need(Need::required)
                                  .vector("gravity", &PhysicsKey::gravity, kXyz, kGravity, "m/s²", "then")
                                  .by_default(kDefaultOfKey)
                                  .vector("wind", &PhysicsKey::wind, kXyz, kWind, "m/s", "then")
                                  .by_default(kDefaultOfKey)
                                  .build();
  return kTable;
}

/// Access to a member of the first key, which stores the fan's own values.
template <class Field>
auto own_of_fan(Field FanKey::*field) {
  return [field](Fan& fan) -> Field& { return fan.keys.front().*field; };
}
bool fan_stands_still(Fan& fan) {
  return fan.keys.size() == 1;
}

const Table& fan_key_rules() {
  static const Table kTable =
      TableBuilder<FanKey>("A fan at a time.")
          .number("time", &FanKey::time, kMoment, "s", "later than the key before")
          .need(Need::required)
          .vector("position", &FanKey::position, kXyz, kPlace, "m", "of the middle of its disc")
          .by_default(kDefaultOfKey)
          .vector("direction", &FanKey::direction, kXyz, kPlace, "", "the way that it blows")
          .nonzero()
          .by_default(kDefaultOfKey)
          .number("speed", &FanKey::speed, within(0, 1000), "m/s", "of the air at the middle of its disc; 0: it is off")
          .by_default(kDefaultOfKey)
          .build();
  return kTable;
}

}  // namespace

const Table& physics_rules() {
  static const Table kTable =
      TableBuilder<Physics>("The world around the cloth.")
          .vector("gravity", &Physics::gravity, kXyz, kGravity, "m/s²", "acceleration of free fall")
          .by_default("9.81 m/s² against the up axis")
          .number("air_density", &Physics::air_density, within(0, 1000), "kg/m³", "0 leaves the air out")
          .vector("wind", &Physics::wind, kXyz, kWind, "m/s", "velocity of the air")
          .table("gusts", &Physics::gusts, gust_rules())
          .choice("interpolation", &Physics::interpolation, kInterpolations, "between its keys")
          .by_default("cubic")
          .written_if([](Physics& physics) { return !physics.keys.empty(); })
          .list(Type::keys, "keys", &Physics::keys, physics_key_rules(),
                [](Physics& physics, std::size_t i) {
                  physics.keys.push_back(i == 0 ? PhysicsKey{0, physics.gravity, physics.wind}
                                                : PhysicsKey(physics.keys.back()));
                })
          .build();
  return kTable;
}

const Table& fan_rules() {
  static const Table kTable =
      TableBuilder<Fan>("Wind in a cone, as of a ventilator, beside the wind of [physics].")
          .plain(Type::name, "name", &Fan::name, "unlike that of any other fan")
          .need(Need::required)
          .vector("position", own_of_fan(&FanKey::position), kXyz, kPlace, "m", "of the middle of its disc")
          .need(Need::here_or_in_first_key)
          .written_if(fan_stands_still)
          .vector("direction", own_of_fan(&FanKey::direction), kXyz, kPlace, "", "the way that it blows")
          .nonzero()
          .need(Need::here_or_in_first_key)
          .written_if(fan_stands_still)
          .number("speed", own_of_fan(&FanKey::speed), within(0, 1000), "m/s",
                  "of the air at the middle of its disc; 0: it is off")
          .written_if(fan_stands_still)
          .number("radius", &Fan::radius, kExtent, "m", "of its disc, where the cone begins")
          .number("angle", &Fan::angle, within(1, 170), "degrees",
                  "full opening of the cone; a round jet in free air opens by 24")
          .number("falloff", &Fan::falloff, within(0, 4), "",
                  "the speed falls with this power of the distance from the apex of the cone: 1 as of a free jet, 0 "
                  "not at all")
          .choice("interpolation", &Fan::interpolation, kInterpolations, "between its keys")
          .list(Type::keys, "keys", &Fan::keys, fan_key_rules(),
                [](Fan& fan, std::size_t i) {
                  if (i > 0) fan.keys.push_back(FanKey(fan.keys.back()));
                })
          .written_if([](Fan& fan) { return fan.keys.size() > 1; })
          .build();
  return kTable;
}

}  // namespace weft::scene
