#include "scene/character_rules.hpp"

#include <array>

#include "scene/common_rules.hpp"

namespace weft::scene {
namespace {

const Table& joint_rules() {
  static const Table kTable =
      TableBuilder<JointNames>("A joint that the motion moves, where it is not found.")
          .plain(
              Type::name, "name", &JointNames::name,
              "Hips, Spine, Chest, Neck, Head, and Shoulder, UpperArm, LowerArm, Hand, UpperLeg, LowerLeg, Foot, Toes "
              "with Left or Right before it")
          .need(Need::required)
          .plain(Type::text, "body", &JointNames::body, "what it is called in the character's file")
          .by_default("found by its name, else by the tree and the lengths of bones")
          .plain(Type::text, "motion", &JointNames::motion, "what it is called in the file of the motion")
          .by_default("found by its name, else by the tree and the lengths of bones")
          .build();
  return kTable;
}

const Table& part_rules() {
  static const Table kTable =
      TableBuilder<BodyPart>("A part of the body with a say of its own in contact.")
          .plain(Type::name, "name", &BodyPart::name,
                 "hands, feet, arms, legs, head, torso or a joint as in character.joint, such as LeftHand; any other "
                 "with bone or material")
          .need(Need::required)
          .plain(Type::text, "bone", &BodyPart::bone, "node of the character's file that it is, with all below it")
          .by_default("what the name says")
          .excludes("material")
          .plain(Type::text, "material", &BodyPart::material, "material of the character's file that it has")
          .by_default("what the name says")
          .excludes("bone")
          .plain(Type::boolean, "collide", &BodyPart::collide, "false lets cloth pass through it")
          .number("friction", &BodyPart::friction, within(0, 10), "",
                  "Coulomb coefficient; of a pair, the geometric mean of both")
          .by_default("that of the character")
          .number("thickness", &BodyPart::thickness, within(0, 1), "m",
                  "half of it is the distance that cloth keeps in addition, as of padding")
          .build();
  return kTable;
}

/// Access to a member of the source of a character.
template <class Kind, class Base, class Field>
auto of_source(Field Base::*field) {
  return [field](Character& c) -> Field& { return std::get<Kind>(c.source).*field; };
}

Value travel_value(const Travel& travel) {
  if (travel.kind == Travel::Kind::speed) return std::vector<double>{travel.speed};
  return std::string(travel.kind == Travel::Kind::none ? "none" : "file");
}

Travel travel_from(const Value& value) {
  if (const auto* speed = std::get_if<std::vector<double>>(&value)) return {Travel::Kind::speed, speed->front()};
  return {std::get<std::string>(value) == "none" ? Travel::Kind::none : Travel::Kind::file, 0};
}

/// The keys that all skinned bodies share.
template <class Kind>
void acting_rows(TableBuilder<Character>& rows) {
  rows.plain(Type::file, "motion", of_source<Kind>(&Acting::motion),
             "file, such as BVH, of a skeleton whose motion it takes over")
      .by_default("none")
      .choice("motion_up", of_source<Kind>(&Acting::motion_up), {"as_file", "x", "y", "z"},
              "axis of that file that points up; of BVH, which does not say, the one along which bodies stand")
      .list(Type::list, "joint", of_source<Kind>(&Acting::joints), joint_rules())
      .plain(Type::text, "clip", of_source<Kind>(&Acting::clip), "animation of the motion, else of the body itself")
      .by_default("the first")
      .number_or(
          "travel", {"file", "none"}, above(0, 20), "m/s",
          "way of the clip over the floor: that of its file, none (it stays in place), or one at a speed, as for clips "
          "that walk on the spot",
          [](Character& c) { return travel_value(of_source<Kind>(&Acting::travel)(c)); },
          [](Character& c, const Value& value) { of_source<Kind> (&Acting::travel)(c) = travel_from(value); })
      .choice("stance", of_source<Kind>(&Acting::stance), {"first", "rest"},
              "pose that it stands in before: the one at start, or that without any animation")
      .number("stance_arms", of_source<Kind>(&Acting::stance_arms), within(0, 120), "degrees",
              "of straight arms from hanging down in that pose, as sleeves have them; 90 of a T")
      .by_default("as the pose has them")
      .plain(Type::boolean, "loop", of_source<Kind>(&Acting::loop),
             "again and again, each round from where the last one has come to")
      .number("crossfade", of_source<Kind>(&Acting::crossfade), within(0, 60), "s",
              "time of the clip at the end of a round that passes over into the next; 0 for clips that close");
}

/// The keys of each source, in the order of CharacterSource.
void source_rows(TableBuilder<Character>& rows) {
  using Rows = TableBuilder<Character>;
  rows.variant("file", Rows()
                           .plain(Type::file, "file", of_source<CharacterFile>(&CharacterFile::path),
                                  "with skeleton, skin and animations; relative paths start at the scene's folder")
                           .need(Need::required)
                           .plain(Type::texts, "meshes", of_source<CharacterFile>(&CharacterFile::meshes),
                                  "that it consists of, by their names or those of their nodes")
                           .by_default("all that the file holds")
                           .plain(Type::texts, "without", of_source<CharacterFile>(&CharacterFile::without),
                                  "meshes that it does not have, likewise")
                           .by_default("what cloths take from the same file by object")
                           .with(acting_rows<CharacterFile>));
  rows.variant("mannequin",
               Rows()
                   .number("height", of_source<Mannequin>(&Mannequin::height), within(0.5, 3), "m",
                           "from the floor to the top of the head")
                   .number("girth", of_source<Mannequin>(&Mannequin::girth), within(0.8, 1.5), "",
                           "widths against those of the slender default")
                   .number("masculinity", of_source<Mannequin>(&Mannequin::masculinity), within(0, 1), "",
                           "0 for the shape of a woman, 1 for that of a man")
                   .number("edge_length", of_source<Mannequin>(&Mannequin::edge_length), within(0.005, 0.1), "m",
                           "of its triangles; shorter at head, hands and feet")
                   .number("walk", of_source<Mannequin>(&Mannequin::walk), within(0, 1000), "m",
                           "how far it walks, from standing to standing; 0 leaves it where it is")
                   .number("pace", of_source<Mannequin>(&Mannequin::pace), within(0.6, 1.6), "m/s", "of even walking")
                   .plain(Type::boolean, "turn_back", of_source<Mannequin>(&Mannequin::turn_back),
                          "at the end of its way it turns round and walks back")
                   .number("arms_out", of_source<Mannequin>(&Mannequin::arms_out), within(0, 60), "degrees",
                           "of the upper arms from the vertical while it walks: room for clothes")
                   .with(acting_rows<Mannequin>));
  rows.variant(
      "sequence",
      Rows()
          .plain(Type::text, "files", of_source<MeshSequence>(&MeshSequence::files),
                 "folder of mesh files, or a file name with one *, in the order of the numbers in their names; "
                 "relative paths start at the scene's folder")
          .need(Need::required)
          .number("fps", of_source<MeshSequence>(&MeshSequence::fps), above(0, 1000), "Hz", "files a second"));
}

}  // namespace

const Table& character_rules() {
  static const std::array<CharacterSource, 3> kSources = {CharacterFile{}, Mannequin{}, MeshSequence{}};
  static const Table kTable =
      TableBuilder<Character>("A body that moves by itself.")
          .plain(Type::name, "name", &Character::name, "unlike that of any other object")
          .need(Need::required)
          .choice_by(
              "source", {"file", "mannequin", "sequence"}, "where it comes from; decides which further keys it has",
              [](Character& c) { return c.source.index(); },
              [](Character& c, std::size_t index) { c.source = kSources[index]; })
          .selects()
          .with(source_rows)
          .number("scale", &Character::scale, above(0, 1e6), "", "metres per unit of the file")
          .by_default("what the file says, else 1")
          .choice("up", &Character::up, {"as_file", "x", "y", "z"},
                  "axis of the file that points up; usually the file says")
          .with([](auto& rows) {
            pose_rows(rows, &Character::pose, "of the file's origin, or of the floor below the mannequin");
          })
          .number("dressing", &Character::dressing, within(0, 3600), "s",
                  "how long it stands still from the start of the preroll on, before it moves")
          .number("blend", &Character::blend, within(0, 60), "s", "in which it then gets going")
          .number(
              "grow", &Character::grow, within(0, 60), "s",
              "in which it grows from its bones to its size at the beginning of its dressing, into clothes that are "
              "narrower than it is but hold its bones")
          .number("room", &Character::room, within(0, 0.1), "m",
                  "between its limbs for cloth: where a motion closes them on cloth that is put on there, or presses "
                  "it to the floor, its skin moves back, each limb by at most half of what is missing; 0 leaves it as "
                  "it is")
          .by_default("that of eight layers of the thickest cloth; 0 where the mannequin walks by itself")
          .number("start", &Character::start, within(0, 86400), "s", "time of the clip that it gets going from")
          .number("speed", &Character::speed, above(0, 100), "", "of the clip; 1 as it is")
          .number("keys_per_second", &Character::keys_per_second, within(1, 1000), "Hz",
                  "key frames that are stored before the simulation starts")
          .by_default("as many as the clip has, 10 to 120")
          .choice("interpolation", &Character::interpolation, kInterpolations, "between its key frames")
          .number("friction", &Character::friction, within(0, 10), "",
                  "Coulomb coefficient; of a pair, the geometric mean of both")
          .plain(Type::boolean, "collide", &Character::collide, "false lets cloth pass through it")
          .list(Type::list, "part", &Character::parts, part_rules())
          .table("look", &Character::look, character_look_rules())
          .not_simulated()
          .build();
  return kTable;
}

}  // namespace weft::scene
