#include "film/scene/contact_rules.hpp"

#include "film/scene/table_builder.hpp"

namespace weft::scene {
namespace {

const Table& search_rules() {
  static const Table kTable =
      TableBuilder<Search>(
          "Methods of collision detection. They change the speed, not the result; coherence, and seldom bounds, change "
          "it by rounding.")
          .choice("bounds", &Search::bounds, {"box", "18-dop", "26-dop"},
                  "bounding volumes of the hierarchy: box is the cheapest to update, 18-dop is the fastest for layers "
                  "at a slant to the axes, 26-dop gives the fewest candidate pairs")
          .choice("tree", &Search::tree, {"binary", "quad", "oct"},
                  "children per node of the hierarchy: two, four or eight")
          .whole_number("leaf", &Search::leaf, within(1, 8), "maximum number of triangles per leaf")
          .plain(Type::boolean, "open_longer_side", &Search::open_longer_side,
                 "of two overlapping nodes, descend only into the longer one, not into both")
          .plain(Type::boolean, "separation_lists", &Search::separation_lists,
                 "resume each traversal where the last one stopped")
          .plain(Type::boolean, "velocity_cones", &Search::velocity_cones,
                 "keep the bounds of slow nodes while their vertices stay inside")
          .plain(Type::boolean, "normal_cones", &Search::normal_cones,
                 "skip regions that are provably too flat to touch themselves")
          .plain(Type::boolean, "coherence", &Search::coherence,
                 "keep closest points, tested by velocity cones, while surfaces hardly move relative to each other")
          .plain(Type::boolean, "reuse", &Search::reuse,
                 "keep candidate pairs and close features until something has moved far")
          .build();
  return kTable;
}

const Table& friction_pair_rules() {
  static const Table kTable =
      TableBuilder<FrictionPair>(
          "Friction between two objects, in place of the geometric mean of their own coefficients.")
          .plain(Type::text, "first", &FrictionPair::first, "name of a cloth, rope, obstacle or character")
          .need(Need::required)
          .plain(Type::text, "second", &FrictionPair::second,
                 "name of the other one, or again of the same cloth; at least one of the two is a cloth or rope")
          .need(Need::required)
          .number("friction", &FrictionPair::friction, within(0, 100), "", "Coulomb coefficient while they slide")
          .number("static_friction", &FrictionPair::static_friction, within(0, 100), "",
                  "Coulomb coefficient while they stick; at least `friction`")
          .by_default("equal to `friction`")
          .build();
  return kTable;
}

}  // namespace

const Table& contact_rules() {
  static const Table kTable =
      TableBuilder<Contact>("Contact between surfaces.")
          .plain(Type::boolean, "self", &Contact::self,
                 "whether cloths and ropes collide with themselves and with each other")
          .plain(Type::boolean, "obstacles", &Contact::obstacles,
                 "whether anything collides with obstacles and characters")
          .number("stiffness", &Contact::stiffness, within(0, 1e9), "N/m",
                  "minimum stiffness of the spring of one contact; heavy particles and short steps get a higher one")
          .table("search", &Contact::search, search_rules())
          .list(Type::list, "pair", &Contact::pairs, friction_pair_rules())
          .choice("response", &Contact::response, {"springs", "velocity_constraints"},
                  "what keeps particles off obstacles: springs, or velocities that the solver prescribes as in the "
                  "paper; all other contacts are springs")
          .build();
  return kTable;
}

}  // namespace weft::scene
