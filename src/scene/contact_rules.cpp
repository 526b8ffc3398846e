#include "scene/contact_rules.hpp"

#include "scene/table_builder.hpp"

namespace weft::scene {
namespace {

const Table& search_rules() {
  static const Table kTable =
      TableBuilder<Search>("How near surfaces are found. Nothing here changes what is found, only how fast.")
          .choice(
              "bounds", &Search::bounds, {"box", "18-dop", "26-dop"},
              "bounding volumes of the hierarchy: cheapest to refit; least work where layers lie slanted to the axes; "
              "fewest pairs")
          .choice("tree", &Search::tree, {"binary", "quad", "oct"}, "children to a node: two, four or eight")
          .whole_number("leaf", &Search::leaf, within(1, 8), "triangles of a leaf at most")
          .plain(Type::boolean, "open_longer_side", &Search::open_longer_side,
                 "of two overlapping nodes open the longer one, instead of both")
          .plain(Type::boolean, "separation_lists", &Search::separation_lists,
                 "walk on from where the last walk stopped")
          .plain(Type::boolean, "velocity_cones", &Search::velocity_cones,
                 "leave the bounds of slow nodes as they are while everything stays inside")
          .plain(Type::boolean, "normal_cones", &Search::normal_cones, "skip regions that are provably flat enough")
          .plain(Type::boolean, "coherence", &Search::coherence,
                 "keep closest points, by velocity cones, while surfaces hardly move relative to each other")
          .plain(Type::boolean, "reuse", &Search::reuse,
                 "keep candidates and close features while nothing has moved far")
          .build();
  return kTable;
}

const Table& friction_pair_rules() {
  static const Table kTable =
      TableBuilder<FrictionPair>("Friction between two objects, instead of what their own coefficients give.")
          .plain(Type::text, "first", &FrictionPair::first, "name of a cloth or obstacle")
          .need(Need::required)
          .plain(Type::text, "second", &FrictionPair::second, "name of another one, or the same cloth")
          .need(Need::required)
          .number("friction", &FrictionPair::friction, within(0, 100), "", "Coulomb coefficient while sliding")
          .number("static_friction", &FrictionPair::static_friction, within(0, 100), "",
                  "Coulomb coefficient until sliding begins")
          .by_default("that of sliding")
          .build();
  return kTable;
}

}  // namespace

const Table& contact_rules() {
  static const Table kTable = TableBuilder<Contact>("Contact of all surfaces.")
                                  .plain(Type::boolean, "self", &Contact::self, "cloth against itself and other cloths")
                                  .plain(Type::boolean, "obstacles", &Contact::obstacles, "cloth against obstacles")
                                  .number("stiffness", &Contact::stiffness, above(0, 1e9), "N/m", "of one contact")
                                  .table("search", &Contact::search, search_rules())
                                  .list(Type::list, "pair", &Contact::pairs, friction_pair_rules())
                                  .choice("response", &Contact::response, {"springs", "velocity_constraints"},
                                          "what keeps a particle off an obstacle: a spring, or its velocity prescribed "
                                          "in the solver; the rest is springs")
                                  .build();
  return kTable;
}

}  // namespace weft::scene
