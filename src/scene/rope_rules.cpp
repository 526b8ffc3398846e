#include "scene/rope_rules.hpp"

#include "scene/common_rules.hpp"
#include "scene/pin_rules.hpp"
#include "scene/ropes.hpp"
#include "scene/table_builder.hpp"

namespace weft::scene {
namespace {

std::vector<std::string> rope_material_names() {
  std::vector<std::string> names;
  for (const RopeMaterial& material : rope_materials()) names.push_back(material.name);
  return names;
}

const Table& rope_key_rules() {
  static const Table kTable =
      TableBuilder<RopeKey>("How long the rope is at a time.")
          .number("time", &RopeKey::time, kMoment, "s", "later than the key before")
          .need(Need::required)
          .number("length", &RopeKey::length, kExtent, "m", "at rest, all of it alike, as of a cord that is drawn in")
          .need(Need::required)
          .build();
  return kTable;
}

const Table& rope_look_rules() {
  static const Table kTable =
      TableBuilder<Look>("How the rope is drawn.")
          .starting_from(rope_look())
          .color("color", &Look::color, "of the rope")
          .number("roughness", &Look::roughness, within(0, 1), "", "0 like a mirror, 1 matte")
          .plain(Type::boolean, "strands", &Look::strands,
                 "draws three twisted strands, of ropes from 9 mm on; false: a smooth round cord")
          .plain(Type::boolean, "visible", &Look::visible, "false leaves it out of the picture")
          .build();
  return kTable;
}

}  // namespace

const Table& rope_rules() {
  const std::string of_material = "that of the material, for its diameter";
  static const Table kTable =
      TableBuilder<Rope>(
          "A rope, cord or line: a thin chain of particles that resists stretch and bending, and meets itself, ropes, "
          "cloth and bodies.")
          .plain(Type::name, "name", &Rope::name, "unlike that of any other object")
          .need(Need::required)
          .points("points", &Rope::points, kXyz, kPlace, "m", "that it runs through at the start, at least two")
          .by_default("a line from `from` to `to`")
          .vector("from", &Rope::from, kXyz, kPlace, "m", "where it begins, in place of points")
          .by_default("none")
          .excludes("points")
          .vector("to", &Rope::to, kXyz, kPlace, "m", "where it ends, in place of points")
          .by_default("none")
          .excludes("points")
          .plain(Type::boolean, "smooth", &Rope::smooth,
                 "true bends it through its points; false: straight between them")
          .plain(Type::boolean, "closed", &Rope::closed, "true joins its end to its beginning: a loop")
          .number(
              "length", &Rope::length, kExtent, "m",
              "at rest; longer than from `from` to `to`, it hangs between them; else it starts stretched, or pushed "
              "together")
          .by_default("that of its first key, else as it starts")
          .whole_number("segments", &Rope::segments, within(3, 20000),
                        "pieces between particles; each at least 1.5 diameters long")
          .by_default("pieces of 3 diameters")
          .number("diameter", &Rope::diameter, above(0, 1), "m", "that contact and air meet")
          .choice_by(
              "material", rope_material_names(),
              "kind of rope that gives mass, stretch and bend for its diameter; steel is wire rope",
              [](Rope& rope) { return static_cast<std::size_t>(rope.material); },
              [](Rope& rope, std::size_t index) { rope.material = static_cast<int>(index); })
          .number("mass", &Rope::mass, above(0, 1e4), "kg/m", "of a metre")
          .by_default(of_material)
          .number("stretch", &Rope::stretch, above(0, 1e10), "N", "force per strain (EA)")
          .by_default(of_material)
          .number("bend", &Rope::bend, within(0, 1e6), "N·m²", "bending stiffness (EI)")
          .by_default(of_material)
          .number("damping", &Rope::damping, within(0, 10), "s",
                  "viscosity of stretch and bending over their stiffness")
          .number("friction", &Rope::friction, within(0, 10), "",
                  "Coulomb coefficient; of a pair, the geometric mean of both")
          .number("drag", &Rope::drag, within(0, 100), "", "air resistance of motion across it; 0 for none")
          .vector("velocity", &Rope::velocity, kXyz, within(-1e4, 1e4), "m/s", "at the start")
          .choice("interpolation", &Rope::interpolation, kInterpolations, "between its keys")
          .list(Type::keys, "keys", &Rope::keys, rope_key_rules())
          .table("look", &Rope::look, rope_look_rules())
          .not_simulated()
          .list(Type::list, "pin", &Rope::pins, rope_pin_rules())
          .list(Type::list, "weight", &Rope::weights, rope_weight_rules())
          .build();
  return kTable;
}

}  // namespace weft::scene
