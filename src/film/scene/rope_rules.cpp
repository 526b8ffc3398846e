#include "film/scene/rope_rules.hpp"

#include "film/scene/common_rules.hpp"
#include "film/scene/pin_rules.hpp"
#include "film/scene/ropes.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::scene {
namespace {

std::vector<std::string> rope_material_names() {
  std::vector<std::string> names;
  for (const RopeMaterial& material : rope_materials()) names.push_back(material.name);
  return names;
}

const Table& rope_key_rules() {
  static const Table kTable =
      TableBuilder<RopeKey>("Length of the rope at one time.")
          .with(key_time_row<RopeKey>)
          .number("length", &RopeKey::length, kSizeRange, "m",
                  "length at rest; a change is distributed evenly over the rope, as if a winch pulled it in")
          .need(Need::required)
          .build();
  return kTable;
}

const Table& rope_look_rules() {
  static const Table kTable =
      TableBuilder<Look>("How the rope is drawn.")
          .starting_from(rope_look())
          .color("color", &Look::color, "color of the rope")
          .number("roughness", &Look::roughness, within(0, 1), "", "roughness of the surface: 0 like a mirror, 1 matte")
          .plain(Type::boolean, "strands", &Look::strands,
                 "true: ropes of at least 9 mm show three twisted strands; false: a smooth round cord")
          .plain(Type::boolean, "visible", &Look::visible, "whether it is drawn")
          .build();
  return kTable;
}

}  // namespace

const Table& rope_rules() {
  const std::string of_material = "that of the material, for its diameter";
  static const Table kTable =
      TableBuilder<Rope>(
          "A rope, cord or line: a thin chain of particles that resists stretch and bending, and collides with itself, "
          "other ropes, cloth and bodies.")
          .plain(Type::name, "name", &Rope::name, "unique name among cloths, ropes, obstacles and characters")
          .need(Need::required)
          .points("points", &Rope::points, kXyz, kPositionRange, "m",
                  "points that it runs through at the start; at least two, three if it is closed")
          .by_default("a line from `from` to `to`")
          .vector("from", &Rope::from, kXyz, kPositionRange, "m", "start point, in place of points")
          .by_default("none")
          .excludes("points")
          .vector("to", &Rope::to, kXyz, kPositionRange, "m", "end point, in place of points")
          .by_default("none")
          .excludes("points")
          .plain(Type::boolean, "smooth", &Rope::smooth,
                 "true: a smooth curve through its points; false: straight between them")
          .plain(Type::boolean, "closed", &Rope::closed, "true: a loop, whose end joins its beginning; needs points")
          .number("length", &Rope::length, kSizeRange, "m",
                  "length at rest; if it exceeds the distance between `from` and `to`, the rope hangs between them; "
                  "otherwise it starts stretched or compressed")
          .by_default("that of its first key, else its length at the start")
          .whole_number("segments", &Rope::segments, within(3, 20000),
                        "number of pieces between particles; each must be at least 1.5 diameters long")
          .by_default("as many as give pieces of 3 diameters")
          .number("diameter", &Rope::diameter, above(0, 1), "m", "diameter, for contact, air resistance and drawing")
          .choice("material", &Rope::material, rope_material_names(),
                  "material, which gives mass, stretch and bend for the diameter; steel is wire rope")
          .number("mass", &Rope::mass, above(0, 1e4), "kg/m", "mass per length")
          .by_default(of_material)
          .number("stretch", &Rope::stretch, above(0, 1e10), "N", "stretching stiffness: force per strain (EA)")
          .by_default(of_material)
          .number("bend", &Rope::bend, within(0, 1e6), "N·m²", "bending stiffness (EI)")
          .by_default(of_material)
          .number("damping", &Rope::damping, within(0, 10), "s",
                  "viscosity of stretch and bending, relative to their stiffness")
          .number("friction", &Rope::friction, within(0, 10), "", kFrictionOfBoth)
          .number("drag", &Rope::drag, within(0, 100), "",
                  "drag coefficient of motion across the rope; 0: no air resistance")
          .vector("velocity", &Rope::velocity, kXyz, within(-1e4, 1e4), "m/s", "initial velocity")
          .choice("interpolation", &Rope::interpolation, kInterpolations, kBetweenKeys)
          .list(Type::keys, "keys", &Rope::keys, rope_key_rules())
          .table("look", &Rope::look, rope_look_rules())
          .not_simulated()
          .list(Type::list, "pin", &Rope::pins, rope_pin_rules())
          .list(Type::list, "weight", &Rope::weights, rope_weight_rules())
          .build();
  return kTable;
}

}  // namespace weft::scene
