#include "physics/simulation/intersections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "core/disjoint_sets.hpp"

namespace weft::simulation {
namespace {

// Largest number of places that a message lists; a crumpled cloth can have hundreds.
constexpr std::size_t kMaxNamedPlaces = 6;

}  // namespace

std::vector<IntersectionPlace> group_intersections(std::span<const collision::CornerPair> pairs,
                                                   const collision::Bodies& bodies, std::span<const std::string> names,
                                                   std::span<const Vec3> x) {
  // Handles each combination of two objects separately, because pairs with a third object may share their vertices.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<collision::CornerPair>> by_bodies;
  for (const collision::CornerPair& pair : pairs)
    by_bodies[{bodies.body_of(pair.a[0]), bodies.body_of(pair.b[0])}].push_back(pair);
  std::vector<IntersectionPlace> places;
  for (const auto& [objects, of_objects] : by_bodies) {
    DisjointSets joined(static_cast<std::size_t>(bodies.vertex_count()));
    for (const auto& [a, b] : of_objects)
      for (const Index v : {a[0], a[1], a[2], b[0], b[1], b[2]}) joined.join(a[0], v);
    std::map<Index, std::set<collision::CornerPair>> groups;
    for (const collision::CornerPair& pair : of_objects) groups[joined.root(pair.a[0])].insert(pair);
    for (const auto& [root, group] : groups) {
      IntersectionPlace place;
      place.a = names[objects.first];
      place.b = names[objects.second];
      place.pairs = group.size();
      std::set<collision::Triangle> triangles;
      Box3 box;
      for (const auto& [a, b] : group) {
        triangles.insert({a, b});
        // Uses the smaller triangle, because a large triangle of a floor would make the place too large.
        const auto box_of = [&](const collision::Triangle& t) { return Box3(x[t[0]]).extend(x[t[1]]).extend(x[t[2]]); };
        const Box3 box_a = box_of(a), box_b = box_of(b);
        box.extend(box_a.diagonal().norm() < box_b.diagonal().norm() ? box_a : box_b);
      }
      place.centre = box.center();
      place.size = box.sizes().maxCoeff();
      for (const collision::Triangle& t : triangles) place.triangles.push_back({x[t[0]], x[t[1]], x[t[2]]});
      places.push_back(std::move(place));
    }
  }
  std::ranges::stable_sort(places, std::ranges::greater{}, &IntersectionPlace::pairs);
  return places;
}

std::string describe(std::span<const IntersectionPlace> places) {
  const auto counted = [](std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  std::size_t pairs = 0;
  for (const IntersectionPlace& place : places) pairs += place.pairs;
  std::string text = fmt::format("{} of triangles that touch or cross in {}: ", counted(pairs, "pair"),
                                 counted(places.size(), "place"));
  for (std::size_t p = 0; p < std::min(places.size(), kMaxNamedPlaces); ++p) {
    const IntersectionPlace& place = places[p];
    const std::string objects =
        place.a == place.b ? fmt::format("'{}' itself", place.a) : fmt::format("'{}' and '{}'", place.a, place.b);
    text += fmt::format("{}{} ({}) around ({:.3g}, {:.3g}, {:.3g}) m, {:.3g} m across", p > 0 ? "; " : "", objects,
                        counted(place.pairs, "pair"), place.centre.x(), place.centre.y(), place.centre.z(), place.size);
  }
  if (places.size() > kMaxNamedPlaces) text += fmt::format("; and {} more", places.size() - kMaxNamedPlaces);
  return text;
}

}  // namespace weft::simulation
