#include "scene/pin_rules.hpp"

#include "scene/common_rules.hpp"
#include "scene/table_builder.hpp"

namespace weft::scene {
namespace {

/// Rows low and high of a part of a cloth.
template <class S>
void part_rows(TableBuilder<S>& rows) {
  rows.plain(Type::text, "panel", &S::panel,
             "of a sewing pattern, of which the part is; fractions and the mask are then of its own width and height, "
             "along its grain")
      .by_default("the whole cloth");
  rows.vector("low", &S::low, kWeftWarp, within(0, 1), "",
              "lower end of the part, in fractions of the size; of a mesh, of its extent along the x and y of its file")
      .single_fills_all();
  rows.vector("high", &S::high, kWeftWarp, within(0, 1), "", "upper end of the part, likewise").single_fills_all();
  rows.plain(Type::text, "edge", &S::edge, "edge of a sewing pattern, as panel.edge, of which the part consists")
      .by_default("all between low and high");
  rows.plain(
          Type::file, "mask", &S::mask,
          "picture (PNG, JPEG or TGA) whose greys are shares: white takes particles whole, black not, what it leaves "
          "transparent neither. It is laid on the UVs of a mesh; on other cloth it spans what low and high span, "
          "its left end at low weft, its foot at low warp")
      .by_default("none");
  rows.choice("vertex_color", &S::vertex_color, {"none", "red", "green", "blue", "brightness"},
              "of the colours that the file of a mesh gives its vertices: what their share is");
  rows.plain(Type::text, "vertex_group", &S::vertex_group,
             "group of vertices, or bone, of the file of a mesh, whose weights are shares")
      .by_default("none");
}

const Table& pin_key_rules() {
  static const auto kPlaceOf = [](PinKey& key) -> Vec3& { return key.pose.position; };
  static const Table kTable =
      TableBuilder<PinKey>("Where a pin holds its particles at a time.")
          .number("time", &PinKey::time, kMoment, "s", "later than the key before")
          .need(Need::required)
          .vector("offset", kPlaceOf, kXyz, kPlace, "m", "how far the particles are then from where they start")
          .by_default("as in the key before; of the first key, none")
          .excludes("position")
          .written_if([](PinKey& key) { return !key.in_world; })
          .when_given([](PinKey& key) { key.in_world = false; })
          .vector("position", kPlaceOf, kXyz, kPlace, "m", "instead of offset: where their middle is then")
          .by_default("as in the key before")
          .excludes("offset")
          .written_if([](PinKey& key) { return key.in_world; })
          .when_given([](PinKey& key) { key.in_world = true; })
          .with(
              [](auto& rows) { rotation_rows(rows, &PinKey::pose, "that of the key before; of the first key, none"); })
          .build();
  return kTable;
}

/// Row "at" of a part of a rope.
template <class S>
void rope_part_rows(TableBuilder<S>& rows) {
  rows.vector("at", &S::at, {"from", "to"}, within(0, 1), "",
              "of a rope, in place of low and high: one place, or all between two, in fractions of its length; the "
              "nearest particles")
      .single_fills_all();
}

void holding_rows(TableBuilder<Pin>& rows) {
  rows.plain(Type::text, "follow", &Pin::follow,
             "name of the obstacle whose motion the particles share, or of the character, at whose nearest places "
             "they stay, or those of a part of it: \"man.torso\"")
      .by_default("none")
      .excludes("keys")
      .number("release", &Pin::release, within(-1, 1e5), "s", "time at which they are let go; negative: never")
      .number("strength", &Pin::strength, above(0, 1e9), "N/m",
              "of a damped spring that draws each of them to where it is to be, times its share")
      .by_default("none: they are held there, as far as nothing is in the way, those with a share of half or more");
}

void moving_rows(TableBuilder<Pin>& rows) {
  rows.choice(
          "interpolation", [](Pin& pin) -> Interpolation& { return pin.motion.interpolation; }, kInterpolations,
          "between its keys")
      .list(
          Type::keys, "keys", [](Pin& pin) -> std::vector<PinKey>& { return pin.motion.keys; }, pin_key_rules(),
          [](Pin& pin, std::size_t i) {
            pin.motion.keys.push_back(i == 0 ? PinKey{} : PinKey(pin.motion.keys.back()));
          });
}

}  // namespace

const Table& pin_rules() {
  static const Table kTable =
      TableBuilder<Pin>("Particles held in place, or moved.")
          .with(part_rows<Pin>)
          .with(holding_rows)
          .number("fade", &Pin::fade, within(0, 1e3), "m",
                  "distance along edges of the cloth at rest up to which what is around them is drawn as well, by ever "
                  "softer springs; it asks for a strength. To hold them and only draw what is around, hold them by a "
                  "pin without strength beside this one: what a pin chooses is never drawn by the fade of another")
          .with(moving_rows)
          .build();
  return kTable;
}

const Table& rope_pin_rules() {
  static const Table kTable = TableBuilder<Pin>("Particles of a rope held in place, or moved.")
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
          .number("mass", &Weight::mass, above(0, 1e9), "kg", "on all particles of the part, by their shares")
          .build();
  return kTable;
}

const Table& rope_weight_rules() {
  static const Table kTable = TableBuilder<Weight>("Mass that hangs on a part of the rope.")
                                  .with(rope_part_rows<Weight>)
                                  .need(Need::required)
                                  .number("mass", &Weight::mass, above(0, 1e9), "kg", "on all particles of the part")
                                  .build();
  return kTable;
}

const Table& attachment_rules() {
  static const Table kTable =
      TableBuilder<Attachment>(
          "Part of a cloth or rope that springs tie to another one or to a body: a button, peg, tack or knot.")
          .plain(Type::name, "name", &Attachment::name, "unlike that of any other attachment")
          .need(Need::required)
          .plain(Type::text, "cloth", &Attachment::cloth, "cloth or rope of which the part is")
          .need(Need::required)
          .plain(Type::text, "to", &Attachment::to,
                 "cloth, rope, obstacle or character to whose nearest places its particles are tied when it begins")
          .need(Need::required)
          .with(part_rows<Attachment>)
          .with(rope_part_rows<Attachment>)
          .by_default("all of it")
          .number("stiffness", &Attachment::stiffness, above(0, 1e9), "N/m",
                  "of the spring of each particle, times its share")
          .number("length", &Attachment::length, within(0, 1e4), "m", "up to which a spring is slack")
          .by_default("as far apart as its ends are when it begins")
          .number("begin", &Attachment::begin, kMoment, "s", "time at which it is tied")
          .by_default("the start of the simulation")
          .written_if([](Attachment& attachment) { return attachment.begin > kMoment.low; })
          .number("release", &Attachment::release, within(-1, 1e5), "s", "time at which it is let go; negative: never")
          .number("breaking_load", &Attachment::breaking_load, above(0, 1e9), "N",
                  "force of all its springs together above which it breaks")
          .by_default("none: it never breaks")
          .build();
  return kTable;
}

}  // namespace weft::scene
