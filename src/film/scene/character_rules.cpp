#include "film/scene/character_rules.hpp"

#include <array>

#include "film/scene/common_rules.hpp"

namespace weft::scene {
namespace {

const Table& joint_rules() {
  static const Table kTable =
      TableBuilder<JointNames>("Names a joint in the files of body and motion, if Weft does not find it there.")
          .plain(Type::name, "name", &JointNames::name,
                 "joint: Hips, Spine, Chest, Neck, Head, or Left or Right followed by Shoulder, UpperArm, LowerArm, "
                 "Hand, UpperLeg, LowerLeg, Foot or Toes; LeftHand and left_hand are the same")
          .need(Need::required)
          .plain(Type::text, "body", &JointNames::body, "its name in the character's file")
          .by_default("found by common names, else by the tree and the lengths of bones")
          .plain(Type::text, "motion", &JointNames::motion, "its name in the motion file")
          .by_default("found by common names, else by the tree and the lengths of bones")
          .build();
  return kTable;
}

const Table& part_rules() {
  static const Table kTable =
      TableBuilder<BodyPart>("A part of the body with its own contact settings.")
          .plain(Type::name, "name", &BodyPart::name,
                 "hands, feet, arms, legs, head, torso, or a joint of character.joint such as LeftHand; any other name "
                 "needs `bone` or `material`")
          .need(Need::required)
          .plain(Type::text, "bone", &BodyPart::bone,
                 "node of the character's file that forms the part, with all nodes below it")
          .by_default("by `name`")
          .excludes("material")
          .plain(Type::text, "material", &BodyPart::material,
                 "material of the character's file; all triangles with it form the part")
          .by_default("by `name`")
          .excludes("bone")
          .plain(Type::boolean, "collide", &BodyPart::collide, kWhetherItCollides)
          .number("friction", &BodyPart::friction, within(0, 10), "", kFrictionOfBoth)
          .by_default("that of the character")
          .number("thickness", &BodyPart::thickness, within(0, 1), "m",
                  "thickness of padding: cloth keeps half of it as additional distance")
          .build();
  return kTable;
}

/// Returns a function that returns a member of the source of a character.
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

/// Adds the keys of SkeletonMotion.
template <class Kind>
void skeleton_motion_rows(TableBuilder<Character>& rows) {
  rows.plain(Type::file, "motion", of_source<Kind>(&SkeletonMotion::motion),
             "file with the motion of another skeleton, such as BVH, which is transferred to this body")
      .by_default("none")
      .choice("motion_up", of_source<Kind>(&SkeletonMotion::motion_up), {"as_file", "x", "y", "z"},
              "axis of the motion file that points up; as_file: as the file states it, for BVH the axis along which "
              "bodies stand")
      .list(Type::list, "joint", of_source<Kind>(&SkeletonMotion::joints), joint_rules())
      .plain(Type::text, "clip", of_source<Kind>(&SkeletonMotion::clip),
             "name of the animation to play, from the motion file, else from the body's own file")
      .by_default("the first")
      .number_or(
          "travel", {"file", "none"}, above(0, 20), "m/s",
          "motion over the floor: as in the file, none (in place), or at this mean speed, for clips that walk on the "
          "spot",
          [](Character& c) { return travel_value(of_source<Kind>(&SkeletonMotion::travel)(c)); },
          [](Character& c, const Value& value) { of_source<Kind> (&SkeletonMotion::travel)(c) = travel_from(value); })
      .choice("stance", of_source<Kind>(&SkeletonMotion::stance), {"first", "rest"},
              "pose while it stands still: that of the clip at `start`, or the rest pose of the skeleton")
      .number("stance_arms", of_source<Kind>(&SkeletonMotion::stance_arms), within(0, 120), "degrees",
              "angle of straight arms in that pose, from hanging down; should fit the sleeves: 45 for an A-pose, 90 "
              "for a T-pose")
      .by_default("as in the pose")
      .plain(Type::boolean, "loop", of_source<Kind>(&SkeletonMotion::loop),
             "whether the clip repeats; each round continues from where the last one ended")
      .number("crossfade", of_source<Kind>(&SkeletonMotion::crossfade), within(0, 60), "s",
              "time at the end of each round that is blended into the next round; 0 for clips that end as they begin");
}

/// Adds the keys of each source, in the order of CharacterSource.
void source_rows(TableBuilder<Character>& rows) {
  using Rows = TableBuilder<Character>;
  rows.variant(
      "file",
      Rows()
          .plain(Type::file, "file", of_source<CharacterFile>(&CharacterFile::path),
                 "character file with skeleton, skin and animations; relative paths start at the scene's folder")
          .need(Need::required)
          .plain(Type::texts, "meshes", of_source<CharacterFile>(&CharacterFile::meshes),
                 "meshes of the file that form the body, by their names or those of their nodes")
          .by_default("all in the file")
          .plain(Type::texts, "without", of_source<CharacterFile>(&CharacterFile::without),
                 "meshes of the file that are left out, named likewise")
          .by_default("those that cloths use from the same file by `object`")
          .with(skeleton_motion_rows<CharacterFile>));
  rows.variant(
      "mannequin",
      Rows()
          .number("height", of_source<Mannequin>(&Mannequin::height), within(0.5, 3), "m",
                  "height from the floor to the top of the head")
          .number("girth", of_source<Mannequin>(&Mannequin::girth), within(0.8, 1.5), "",
                  "factor on the widths and depths of the slender default")
          .number("masculinity", of_source<Mannequin>(&Mannequin::masculinity), within(0, 1), "",
                  "0: the shape of a woman, 1: that of a man")
          .number("edge_length", of_source<Mannequin>(&Mannequin::edge_length), within(0.005, 0.1), "m",
                  "edge length of its triangles; shorter on head, hands and feet")
          .number("walk", of_source<Mannequin>(&Mannequin::walk), within(0, 1000), "m",
                  "distance that it walks, from standing to standing; 0: it stands")
          .number("pace", of_source<Mannequin>(&Mannequin::pace), within(0.6, 1.6), "m/s", "steady walking speed")
          .plain(Type::boolean, "turn_back", of_source<Mannequin>(&Mannequin::turn_back),
                 "whether it turns around at the end of its walk and walks back")
          .number("arms_out", of_source<Mannequin>(&Mannequin::arms_out), within(0, 60), "degrees",
                  "angle of the upper arms from the vertical while it walks, which leaves space for clothes")
          .with(skeleton_motion_rows<Mannequin>));
  rows.variant("sequence", Rows()
                               .plain(Type::text, "files", of_source<MeshSequence>(&MeshSequence::files),
                                      "folder of mesh files, or a file name with one *; their order is that of the "
                                      "numbers in their names; relative paths start at the scene's folder")
                               .need(Need::required)
                               .number("fps", of_source<MeshSequence>(&MeshSequence::fps), above(0, 1000), "Hz",
                                       "files per second"));
}

}  // namespace

const Table& character_rules() {
  static const std::array<CharacterSource, 3> kSources = {CharacterFile{}, Mannequin{}, MeshSequence{}};
  static const Table kTable =
      TableBuilder<Character>(
          "A body whose motion is given: from a file, as the built-in mannequin, or as a sequence of meshes.")
          .plain(Type::name, "name", &Character::name, "unique name among cloths, ropes, obstacles and characters")
          .need(Need::required)
          .choice_by(
              "source", {"file", "mannequin", "sequence"},
              "where the body comes from; it decides which other keys are allowed",
              [](Character& c) { return c.source.index(); },
              [](Character& c, std::size_t index) { c.source = kSources[index]; })
          .selects()
          .with(source_rows)
          .number("scale", &Character::scale, above(0, 1e6), "", "metres per unit of the file")
          .by_default("as the file states, else 1")
          .choice("up", &Character::up, {"as_file", "x", "y", "z"},
                  "axis of the file that points up; as_file: as the file states it, else y")
          .with([](auto& rows) {
            pose_rows(rows, &Character::pose, "position of the file's origin, or of the floor below the mannequin");
          })
          .number("dressing", &Character::dressing, within(0, 3600), "s",
                  "time for which it stands still, counted from the start of the preroll, before its motion begins")
          .number("blend", &Character::blend, within(0, 60), "s", "time in which its motion then starts smoothly")
          .number(
              "grow", &Character::grow, within(0, 60), "s",
              "time at the beginning of `dressing` in which it grows from its bones to its size, into clothes that "
              "are too narrow but enclose its bones; 0: only if a garment from a pattern cannot be moved out of it, "
              "in half of `dressing`")
          .number("room", &Character::clearance, within(0, 0.1), "m",
                  "clearance for cloth between its limbs: if the motion presses limbs on cloth, or cloth on the floor, "
                  "the skin moves back, each limb by at most half of the missing clearance; 0: never")
          .by_default(
              "eight times the thickness of the thickest cloth; 0 if it does not collide, or for a mannequin without "
              "`motion`")
          .number("start", &Character::start, within(0, 86400), "s", "time of the clip at which its motion begins")
          .number("speed", &Character::speed, above(0, 100), "", "factor on the speed of the clip")
          .number("keys_per_second", &Character::keys_per_second, within(1, 1000), "Hz",
                  "key frames of the skin per second, which are computed before the simulation starts")
          .by_default("as many as the clip has, but 10 to 120")
          .choice("interpolation", &Character::interpolation, kInterpolations,
                  "interpolation between its key frames; cubic is smooth")
          .number("friction", &Character::friction, within(0, 10), "", kFrictionOfBoth)
          .plain(Type::boolean, "collide", &Character::collide, kWhetherItCollides)
          .list(Type::list, "part", &Character::parts, part_rules())
          .table("look", &Character::look, character_look_rules())
          .not_simulated()
          .build();
  return kTable;
}

}  // namespace weft::scene
