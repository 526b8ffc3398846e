#include "film/scene/pin_rules.hpp"

#include "film/scene/common_rules.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::scene {
namespace {

/// Adds the keys of a ClothPart, which select particles of a cloth and give the strength of the effect on each
/// particle.
template <class S>
void part_rows(TableBuilder<S>& rows) {
  rows.plain(Type::text, "panel", &S::panel,
             "panel of a sewing pattern that contains the part; low, high and mask then refer to the width and height "
             "of this panel, along its grain")
      .by_default("the whole cloth");
  rows.vector("low", &S::low, kWeftWarp, within(0, 1), "",
              "lower corner of the part, in fractions of the size along weft and warp; for a mesh, of its extent along "
              "x and y of the scene, before position and rotation")
      .single_fills_all();
  rows.vector("high", &S::high, kWeftWarp, within(0, 1), "", "upper corner of the part, likewise").single_fills_all();
  rows.plain(Type::text, "edge", &S::edge, "edge of a sewing pattern, as panel.edge, to which the part is limited")
      .by_default("no such limit");
  rows.plain(Type::file, "mask", &S::mask,
             "picture (PNG, JPEG or TGA) that gives each particle a fraction: white 1, black and transparent 0. It "
             "lies on the UVs of a mesh; on other cloth it covers all of the cloth or panel: left edge = low weft, "
             "bottom edge = low warp")
      .by_default("none");
  rows.choice("vertex_color", &S::vertex_color, {"none", "red", "green", "blue", "brightness"},
              "color channel of the vertices of a mesh file that gives each particle its fraction");
  rows.plain(Type::text, "vertex_group", &S::vertex_group,
             "vertex group or bone of a mesh file whose weights give each particle its fraction")
      .by_default("none");
}

const Table& pin_key_rules() {
  static const auto kPlaceOf = [](PinKey& key) -> Vec3& { return key.pose.position; };
  static const Table kTable =
      TableBuilder<PinKey>("Where a pin holds its particles at one time.")
          .with(key_time_row<PinKey>)
          .vector("offset", kPlaceOf, kXyz, kPositionRange, "m", "displacement of the particles from where they start")
          .by_default("as in the key before; in the first key, none")
          .excludes("position")
          .written_if([](PinKey& key) { return !key.in_world; })
          .when_given([](PinKey& key) { key.in_world = false; })
          .vector("position", kPlaceOf, kXyz, kPositionRange, "m",
                  "in place of offset: position of the particles' centre in the world")
          .by_default("as in the key before")
          .excludes("offset")
          .written_if([](PinKey& key) { return key.in_world; })
          .when_given([](PinKey& key) { key.in_world = true; })
          .with([](auto& rows) { rotation_rows(rows, &PinKey::pose, "as in the key before; in the first key, none"); })
          .build();
  return kTable;
}

/// Adds the key `at` of a part of a rope.
template <class S>
void rope_part_rows(TableBuilder<S>& rows) {
  rows.vector("at", &S::at, {"from", "to"}, within(0, 1), "",
              "for a rope, in place of low and high: one place, or all between two places, in fractions of its length; "
              "the nearest particles count")
      .single_fills_all();
}

void holding_rows(TableBuilder<Pin>& rows) {
  rows.plain(Type::text, "follow", &Pin::follow,
             "obstacle, character, or part of a character such as \"man.torso\", with which the particles move; on a "
             "character, each follows the nearest place of the skin")
      .by_default("none")
      .excludes("keys")
      .number("release", &Pin::release, within(-1, 1e5), "s", "time at which the pin lets go; negative: never")
      .number("strength", &Pin::strength, above(0, 1e9), "N/m",
              "stiffness of a damped spring that pulls each particle to its target, times the particle's fraction")
      .by_default("none: particles with a fraction of at least 0.5 are held exactly, unless something is in the way");
}

void moving_rows(TableBuilder<Pin>& rows) {
  rows.choice(
          "interpolation", [](Pin& pin) -> Interpolation& { return pin.motion.interpolation; }, kInterpolations,
          kBetweenKeys)
      .list(
          Type::keys, "keys", [](Pin& pin) -> std::vector<PinKey>& { return pin.motion.keys; }, pin_key_rules(),
          [](Pin& pin, std::size_t i) {
            pin.motion.keys.push_back(i == 0 ? PinKey{} : PinKey(pin.motion.keys.back()));
          });
}

}  // namespace

const Table& pin_rules() {
  static const Table kTable =
      TableBuilder<Pin>("Particles that are held in place or moved.")
          .with(part_rows<Pin>)
          .with(holding_rows)
          .number("fade", &Pin::fade, within(0, 1e3), "m",
                  "distance along the cloth at rest up to which particles around the part are pulled as well, with "
                  "less strength the farther they are; needs `strength`. To hold the part itself exactly, add a pin "
                  "without strength for it: the fade of one pin never pulls the part of another")
          .with(moving_rows)
          .build();
  return kTable;
}

const Table& rope_pin_rules() {
  static const Table kTable = TableBuilder<Pin>("Particles of a rope that are held in place or moved.")
                                  .with(rope_part_rows<Pin>)
                                  .need(Need::required)
                                  .with(holding_rows)
                                  .with(moving_rows)
                                  .build();
  return kTable;
}

const Table& weight_rules() {
  static const Table kTable =
      TableBuilder<Weight>("Mass that hangs on a part of the cloth, as lead does in the hem of a curtain.")
          .with(part_rows<Weight>)
          .number("mass", &Weight::mass, above(0, 1e9), "kg",
                  "total mass, distributed over the particles of the part by their fractions")
          .build();
  return kTable;
}

const Table& rope_weight_rules() {
  static const Table kTable =
      TableBuilder<Weight>("Mass that hangs on a part of the rope.")
          .with(rope_part_rows<Weight>)
          .need(Need::required)
          .number("mass", &Weight::mass, above(0, 1e9), "kg", "total mass, distributed over the particles of the part")
          .build();
  return kTable;
}

const Table& attachment_rules() {
  static const Table kTable =
      TableBuilder<Attachment>(
          "Springs that tie a part of a cloth or rope to another one or to a body: a button, peg, tack or knot.")
          .plain(Type::name, "name", &Attachment::name, "unique name of the attachment")
          .need(Need::required)
          .plain(Type::text, "cloth", &Attachment::cloth, "cloth or rope to which the part belongs")
          .need(Need::required)
          .plain(Type::text, "to", &Attachment::to,
                 "cloth, rope, obstacle or character; each particle is tied to its nearest place at `begin`")
          .need(Need::required)
          .with(part_rows<Attachment>)
          .with(rope_part_rows<Attachment>)
          .by_default("all of it")
          .number("stiffness", &Attachment::stiffness, above(0, 1e9), "N/m",
                  "stiffness of the spring of each particle, times the particle's fraction")
          .number("length", &Attachment::length, within(0, 1e4), "m",
                  "length up to which a spring is slack; beyond it, the spring pulls")
          .by_default("the distance of its ends at `begin`")
          .number("begin", &Attachment::begin, kTimeRange, "s", "time at which it is tied")
          .by_default("the start of the simulation")
          .written_if([](Attachment& attachment) { return attachment.begin > kTimeRange.low; })
          .number("release", &Attachment::release, within(-1, 1e5), "s",
                  "time at which it is released; negative: never")
          .number("breaking_load", &Attachment::breaking_load, above(0, 1e9), "N",
                  "total force of its springs above which it breaks for good")
          .by_default("none: it never breaks")
          .build();
  return kTable;
}

}  // namespace weft::scene
