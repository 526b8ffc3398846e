#include "film/scene/physics_rules.hpp"

#include "film/scene/common_rules.hpp"
#include "film/scene/table_builder.hpp"
#include "physics/model/air.hpp"

namespace weft::scene {
namespace {

const Range kGravity = within(-1e5, 1e5);  // [m/s²]
const Range kWind = within(-1000, 1000);   // [m/s]

const Table& gust_rules() {
  static const Table kTable =
      TableBuilder<Gusts>("Turbulence of the air: random eddies that the wind carries along, the same in every run.")
          .number("speed", &Gusts::speed, within(0, 1000), "m/s",
                  "root mean square of each component of the velocity that gusts add to the wind; 0: no gusts")
          .number("size", &Gusts::size, above(0, 1e5), "m",
                  "size of the eddies with the most energy (integral length scale)")
          .whole_number("seed", &Gusts::seed, within(0, 1e9),
                        "selects the random gusts; another number gives other gusts")
          .build();
  return kTable;
}

const Table& physics_key_rules() {
  static const Table kTable =
      TableBuilder<PhysicsKey>("Gravity and wind at one time.")
          .with(key_time_row<PhysicsKey>)
          .vector("gravity", &PhysicsKey::gravity, kXyz, kGravity, "m/s²", "gravity at this time")
          .by_default(kDefaultOfKey)
          .vector("wind", &PhysicsKey::wind, kXyz, kWind, "m/s", "wind at this time")
          .by_default(kDefaultOfKey)
          .build();
  return kTable;
}

const Table& fan_key_rules() {
  static const Table kTable =
      TableBuilder<FanKey>("The fan at one time.")
          .with(key_time_row<FanKey>)
          .vector("position", &FanKey::position, kXyz, kPositionRange, "m", "centre of the fan's disc")
          .by_default(kDefaultOfKey)
          .vector("direction", &FanKey::direction, kXyz, kPositionRange, "",
                  "direction in which it blows, of any length but 0")
          .nonzero()
          .by_default(kDefaultOfKey)
          .number("speed", &FanKey::speed, within(0, 1000), "m/s", "speed of the air at the centre of the disc; 0: off")
          .by_default(kDefaultOfKey)
          .build();
  return kTable;
}

}  // namespace

const Table& physics_rules() {
  static const Table kTable =
      TableBuilder<Physics>("The world around the cloth.")
          .vector("gravity", &Physics::gravity, kXyz, kGravity, "m/s²", "acceleration due to gravity")
          .by_default("9.81 m/s² against the up axis")
          .number("air_density", &Physics::air_density, within(0, 1000), "kg/m³",
                  "density of the air, which causes drag; 0: no air")
          .vector("wind", &Physics::wind, kXyz, kWind, "m/s", "mean velocity of the air, the same everywhere")
          .table("gusts", &Physics::gusts, gust_rules())
          .choice("interpolation", &Physics::interpolation, kInterpolations, kBetweenKeys)
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
      TableBuilder<Fan>("A fan that blows air in a cone, in addition to the wind of [physics].")
          .plain(Type::name, "name", &Fan::name, "unique name of the fan")
          .need(Need::required)
          .vector("position", of_first_key(&FanKey::position), kXyz, kPositionRange, "m", "centre of the fan's disc")
          .need(Need::here_or_in_first_key)
          .written_if(stands_still<Fan>)
          .vector("direction", of_first_key(&FanKey::direction), kXyz, kPositionRange, "",
                  "direction in which it blows, of any length but 0")
          .nonzero()
          .need(Need::here_or_in_first_key)
          .written_if(stands_still<Fan>)
          .number("speed", of_first_key(&FanKey::speed), within(0, 1000), "m/s",
                  "speed of the air at the centre of the disc; 0: off")
          .written_if(stands_still<Fan>)
          .number("radius", &Fan::radius, kSizeRange, "m", "radius of the disc, where the cone begins")
          .number("angle", &Fan::angle, within(1, 170), "degrees",
                  "full opening angle of the cone; a round jet in free air has 24")
          .number("falloff", &Fan::falloff, within(0, 4), "",
                  "the speed falls with this power of the distance from the apex of the cone: 1 as in a free jet, 0 "
                  "not at all")
          .choice("interpolation", &Fan::interpolation, kInterpolations, kBetweenKeys)
          .list(Type::keys, "keys", &Fan::keys, fan_key_rules(), copy_key_before<Fan>)
          .written_if(moves<Fan>)
          .build();
  return kTable;
}

}  // namespace weft::scene
