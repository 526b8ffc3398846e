#include "support/intersections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

namespace weft::support {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

const Triangles kOneFace = {{0, 1, 2}};
// A right triangle in the plane z = 0 with its right-angled corner at the origin.
const std::vector<Vec3> kFloor = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TestedObject cloth(const std::vector<Vec3>& positions, const Triangles& triangles = kOneFace) {
  return {"cloth", true, positions, triangles};
}
TestedObject obstacle(const std::vector<Vec3>& positions, const Triangles& triangles = kOneFace) {
  return {"obstacle", false, positions, triangles};
}

std::size_t pairs_of(const std::vector<TestedObject>& objects) {
  return find_intersections(objects).pairs.size();
}

// Number of pairs for two faces of one cloth without a common vertex.
std::size_t pairs_within_cloth(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::vector<Vec3> positions = a;
  positions.insert(positions.end(), b.begin(), b.end());
  return pairs_of({cloth(positions, {{0, 1, 2}, {3, 4, 5}})});
}

// Number of pairs for two cloths of one face each. Expects the same number for two faces of one cloth, and for a cloth
// and an obstacle.
std::size_t pairs_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const std::size_t count = pairs_of({cloth(a), cloth(b)});
  EXPECT_EQ(pairs_within_cloth(a, b), count);
  EXPECT_EQ(pairs_of({cloth(a), obstacle(b)}), count);
  EXPECT_EQ(pairs_of({obstacle(a), cloth(b)}), count);
  return count;
}

// An upright triangle whose lowest corner is at height z over the inside of kFloor.
std::vector<Vec3> hanging(double z) {
  return {{0.25, 0.25, z}, {0.25, 0.25, z + 1}, {0.5, 0.25, z + 1}};
}

TEST(FindIntersections, CrossingTrianglesAreOnePairWithItsFaces) {
  const std::vector<Vec3> spike = hanging(-0.5);
  const Intersections intersections = find_intersections(std::vector<TestedObject>{cloth(kFloor), cloth(spike)});
  ASSERT_EQ(intersections.pairs.size(), 1u);
  EXPECT_EQ(intersections.pairs[0], (IntersectingPair{{0, 0}, {1, 0}}));
  EXPECT_EQ(pairs_between(kFloor, spike), 1u);
}

TEST(FindIntersections, PiecesOfRopeThatPassThroughAFaceOrMeetAreFound) {
  const Triangles chain = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}};
  const std::vector<Vec3> through = {{0.2, 0.2, 1}, {0.2, 0.2, 0.5}, {0.2, 0.2, -0.5}, {0.2, 0.2, -1}};
  const Intersections intersections =
      find_intersections(std::vector<TestedObject>{cloth(through, chain), cloth(kFloor)});
  ASSERT_EQ(intersections.pairs.size(), 1u);
  EXPECT_EQ(intersections.pairs[0], (IntersectingPair{{0, 1}, {1, 0}}));
  EXPECT_TRUE(intersections.degenerate.empty());
  // The last piece crosses the first piece; in the second chain, it ends 1e-9 away from their common plane.
  EXPECT_EQ(pairs_of({cloth({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, -1, 0}}, chain)}), 1u);
  EXPECT_EQ(pairs_of({cloth({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, -1, 1e-9}}, chain)}), 0u);
  // The second piece is folded onto the first, so they meet. The third piece starts on the first, and meets it, too.
  EXPECT_EQ(pairs_of({cloth({{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0}}, chain)}), 2u);
}

TEST(FindIntersections, TouchingCountsAndTheLeastGapDoesNot) {
  EXPECT_EQ(pairs_between(kFloor, hanging(0)), 1u);
  EXPECT_EQ(pairs_between(kFloor, hanging(1e-12)), 0u);
  EXPECT_EQ(pairs_between(kFloor, hanging(-1e-12)), 1u);
  EXPECT_EQ(pairs_between(kFloor, hanging(std::numeric_limits<double>::denorm_min())), 0u);
}

TEST(FindIntersections, TouchingOnASlantedPlaneIsDecidedExactly) {
  // `slanted` lies exactly in the plane x + y + z = 0.75. The corner (0.25, 0.25, z) is in this plane only if z = 0.25;
  // one unit in the last place of z moves it off the plane.
  const std::vector<Vec3> slanted = {{0.75, 0, 0}, {0, 0.75, 0}, {0, 0, 0.75}};
  const auto above = [](double z) { return std::vector<Vec3>{{0.25, 0.25, z}, {1, 1, 1}, {1, 1.25, 1}}; };
  EXPECT_EQ(pairs_between(slanted, above(0.25)), 1u);
  EXPECT_EQ(pairs_between(slanted, above(std::nextafter(0.25, 1))), 0u);
  EXPECT_EQ(pairs_between(slanted, above(std::nextafter(0.25, 0))), 1u);
}

TEST(FindIntersections, CoplanarTrianglesIntersectWhereTheyOverlap) {
  EXPECT_EQ(pairs_between(kFloor, {{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}}), 1u) << "one inside the other";
  EXPECT_EQ(pairs_between(kFloor, {{0.5, 0.1, 0}, {2, 0.1, 0}, {2, 0.2, 0}}), 1u) << "overlap";
  EXPECT_EQ(pairs_between(kFloor, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}), 1u) << "a corner in common";
  EXPECT_EQ(pairs_between(kFloor, {{1 + 1e-12, 0, 0}, {2, 0, 0}, {2, 1, 0}}), 0u) << "side by side";
  EXPECT_EQ(pairs_between(kFloor, {{0, 0, 1e-12}, {1, 0, 1e-12}, {0, 1, 1e-12}}), 0u) << "on top of each other";
}

TEST(FindIntersections, FacesThatShareAnEdgeAreSkipped) {
  const std::vector<Vec3> folded = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}};
  EXPECT_EQ(pairs_of({cloth(folded, {{0, 1, 2}, {1, 0, 3}})}), 0u);
  EXPECT_EQ(pairs_of({cloth(folded, {{0, 1, 2}, {2, 1, 0}})}), 0u);
}

TEST(FindIntersections, FacesThatShareAVertexIntersectIfAnOppositeEdgeCrosses) {
  const Triangles fan = {{0, 1, 2}, {0, 3, 4}};
  const auto pairs = [&](const Vec3& p3, const Vec3& p4) {
    return pairs_of({cloth({kFloor[0], kFloor[1], kFloor[2], p3, p4}, fan)});
  };
  EXPECT_EQ(pairs({-1, 0, 0}, {0, -1, 0}), 0u) << "only the vertex in common";
  EXPECT_EQ(pairs({-1, 0, 1}, {0, -1, 1}), 0u) << "only the vertex in common, out of the plane";
  EXPECT_EQ(pairs({0.2, 0.2, -1}, {0.2, 0.2, 1}), 1u) << "the second face's opposite edge pierces the first";
  EXPECT_EQ(pairs({1, 1, -1}, {1, 1, 1}), 1u) << "the first face's opposite edge pierces the second";
  EXPECT_EQ(pairs({0.2, 0.2, 0}, {0.3, 0.2, 1}), 1u) << "the end of the opposite edge touches";
  EXPECT_EQ(pairs({0.2, 0.2, 1e-12}, {0.3, 0.2, 1}), 0u) << "the end of the opposite edge is just off";
  EXPECT_EQ(pairs({0.2, 0.1, 0}, {0.1, 0.2, 0}), 1u) << "coplanar, on top of each other";
}

TEST(FindIntersections, TheSameIndexInTwoObjectsIsNotASharedVertex) {
  EXPECT_EQ(pairs_of({cloth(kFloor), cloth(kFloor)}), 1u);
}

TEST(FindIntersections, ObstaclesMayIntersectEachOther) {
  const std::vector<Vec3> spike = hanging(-0.5);
  EXPECT_EQ(pairs_of({obstacle(kFloor), obstacle(spike)}), 0u);
  std::vector<Vec3> both = kFloor;
  both.insert(both.end(), spike.begin(), spike.end());
  EXPECT_EQ(pairs_of({obstacle(both, {{0, 1, 2}, {3, 4, 5}})}), 0u);
}

TEST(FindIntersections, FacesWithoutAreaAreNamedAndNotTested) {
  const std::vector<Vec3> needle = {{0.2, 0.2, -1}, {0.2, 0.2, 0}, {0.2, 0.2, 1}};
  const Intersections intersections = find_intersections(std::vector<TestedObject>{cloth(kFloor), obstacle(needle)});
  EXPECT_TRUE(intersections.pairs.empty());
  ASSERT_EQ(intersections.degenerate.size(), 1u);
  EXPECT_EQ(intersections.degenerate[0], (TestedFace{1, 0}));
}

TEST(FindIntersections, BrokenInputIsRefused) {
  std::vector<Vec3> positions = kFloor;
  positions[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(find_intersections(std::vector<TestedObject>{cloth(positions)}), std::invalid_argument);
  EXPECT_THROW(find_intersections(std::vector<TestedObject>{cloth(kFloor, {{0, 1, 3}})}), std::invalid_argument);
}

// A wavy sheet of n × n quads over the unit square, at height z.
std::pair<std::vector<Vec3>, Triangles> sheet(int n, double z, double wave) {
  std::vector<Vec3> positions;
  Triangles triangles;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = double{1} * i / n, y = double{1} * j / n;
      positions.emplace_back(x, y, z + wave * std::sin(9 * x + 5 * y));
      if (i == n || j == n) continue;
      const Index a = static_cast<Index>(i + (n + 1) * j), b = a + 1, c = a + n + 1, d = c + 1;
      triangles.push_back({a, b, d});
      triangles.push_back({a, d, c});
    }
  }
  return {positions, triangles};
}

TEST(FindIntersections, TheBoxesMissNothingThatAllPairsFind) {
  const auto [flat, flat_faces] = sheet(12, 0, 0);
  const auto [wavy, wavy_faces] = sheet(9, 0.01, 0.1);
  std::size_t all_pairs = 0;
  for (const auto& a : flat_faces) {
    for (const auto& b : wavy_faces) all_pairs += pairs_of({cloth(flat, {a}), cloth(wavy, {b})});
  }
  EXPECT_GT(all_pairs, 50u);
  EXPECT_EQ(pairs_of({cloth(flat, flat_faces), cloth(wavy, wavy_faces)}), all_pairs);
  EXPECT_EQ(pairs_of({cloth(flat, flat_faces), obstacle(wavy, wavy_faces)}), all_pairs);
  EXPECT_EQ(pairs_of({cloth(wavy, wavy_faces)}), 0u) << "a wavy sheet does not intersect itself";
}

TEST(FindIntersections, SnapshotsAreTestedByKindAndCountedByName) {
  const auto surface = [](const char* name, frame::ObjectKind kind) {
    auto made = std::make_shared<frame::Surface>();
    made->name = name;
    made->kind = kind;
    made->triangles = kOneFace;
    return made;
  };
  frame::FrameSnapshot snapshot;
  snapshot.surfaces = {surface("sheet", frame::ObjectKind::cloth), surface("body", frame::ObjectKind::character),
                       surface("ball", frame::ObjectKind::obstacle)};
  snapshot.states = {{kFloor, {}}, {hanging(-0.5), {}}, {hanging(-0.25), {}}};
  const auto objects = objects_of(snapshot);
  const std::vector<PairCount> expected = {{"ball", "sheet", 1}, {"body", "sheet", 1}};
  EXPECT_EQ(count_by_objects(find_intersections(objects), objects), expected);
}

}  // namespace
}  // namespace weft::support
