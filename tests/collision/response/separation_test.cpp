// Tests of Separation. Exact predicates, at 65 times of a step, check that no pair with a separating plane meets.
#include "physics/collision/response/separation.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "support/intersections.hpp"

namespace weft::collision {
namespace {

/// Pairs of triangles, each pair far from all others.
struct IsolatedPairs {
  std::vector<Triangle> triangles;  // pair p has triangles 2p and 2p + 1
  std::vector<TrianglePair> pairs;
  std::vector<Vec3> x_t0, x_t1;
  std::vector<std::uint8_t> movable;

  std::vector<Vec3> at(double t) const {
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < x_t0.size(); ++i) x.push_back((1 - t) * x_t0[i] + t * x_t1[i]);
    return x;
  }
  Separation separation() const {
    Separation separation(triangles, {});
    separation.watch(pairs, x_t0);
    return separation;
  }
};

/// Pairs of random triangles of about 0.1 m. The triangles of a pair start at least 1e-4 m apart. Each vertex moves by
/// up to `motion` [m] along each axis.
IsolatedPairs random_pairs(int count, double motion, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&](double size) {
    const double x = number(engine), y = number(engine), z = number(engine);
    return Vec3(size * x, size * y, size * z);
  };
  IsolatedPairs made;
  while (static_cast<int>(made.pairs.size()) < count) {
    const auto p = static_cast<Index>(made.pairs.size());
    const Vec3 place(p % 10, p / 10, 0);
    std::vector<Vec3> corners;
    const Vec3 apart = vector(0.05);
    for (int k = 0; k < 6; ++k) corners.push_back(vector(0.05) + (k < 3 ? Vec3(Vec3::Zero()) : apart));
    const Triangle a{0, 1, 2}, b{3, 4, 5};
    if (closest_features({a, b}, corners).points.distance_sq < 1e-8) continue;
    // The closest features can be apart although an edge pierces a face.
    const std::array<Triangle, 1> face_a{a}, face_b{b};
    const support::TestedObject objects[] = {{"a", true, corners, face_a}, {"b", true, corners, face_b}};
    if (!support::find_intersections(objects).pairs.empty()) continue;

    const Index first = 6 * p;
    made.triangles.push_back({first, first + 1, first + 2});
    made.triangles.push_back({first + 3, first + 4, first + 5});
    made.pairs.push_back({2 * p, 2 * p + 1});
    for (const Vec3& corner : corners) {
      made.x_t0.push_back(place + corner);
      made.x_t1.push_back(place + corner + vector(motion));
    }
  }
  made.movable.assign(made.x_t0.size(), 1);
  return made;
}

// Numbers of the pairs that intersect at one of 65 times of the step.
std::set<Index> meeting(const IsolatedPairs& pairs) {
  std::vector<Triangle> sides[2];
  for (std::size_t t = 0; t < pairs.triangles.size(); ++t) sides[t % 2].push_back(pairs.triangles[t]);
  std::set<Index> found;
  for (int sample = 0; sample <= 64; ++sample) {
    const std::vector<Vec3> x = pairs.at(sample / 64.0);
    const support::TestedObject objects[] = {{"a", true, x, sides[0]}, {"b", true, x, sides[1]}};
    for (const auto& pair : support::find_intersections(objects).pairs)
      if (pair.a.object != pair.b.object) found.insert(pair.a.face);
  }
  return found;
}

std::set<Index> failing(const IsolatedPairs& pairs) {
  Separation separation = pairs.separation();
  std::set<Index> found;
  for (const CornerPair& pair : separation.find_failing(pairs.x_t0, pairs.x_t1)) found.insert(pair.a[0] / 6);
  return found;
}

TEST(Separation, CertifiedPairsDoNotMeetOnTheirWay) {
  for (double motion : {0.01, 0.05, 0.2}) {
    const IsolatedPairs pairs = random_pairs(200, motion, 1);
    const std::set<Index> met = meeting(pairs), uncertified = failing(pairs);
    for (Index p : met) EXPECT_TRUE(uncertified.contains(p)) << "pair " << p << " at motions of " << motion;
    EXPECT_LT(uncertified.size(), 200u);
    if (motion > 0.1) {
      EXPECT_GT(met.size(), 20u);
    }
  }
}

TEST(Separation, PairsInSlowMotionAreNearlyAllCertified) {
  // With motions of a tenth of the size of the triangles, a few per cent of the pairs meet. Not many more may lack a
  // plane.
  const IsolatedPairs pairs = random_pairs(200, 0.005, 2);
  EXPECT_LT(failing(pairs).size(), 2 * meeting(pairs).size() + 20);
}

// The result for vertex stars depends only on positions, so a remembered result must equal that of a fresh check.
TEST(Separation, ARememberedResultEqualsThatOfANewCheck) {
  constexpr Index kSide = 6;
  std::vector<Triangle> triangles;
  std::vector<Vec3> start;
  for (Index v = 0; v < kSide * kSide; ++v) start.emplace_back(v % kSide, v / kSide, 0);
  for (Index y = 0; y + 1 < kSide; ++y) {
    for (Index v = y * kSide; v + 1 < (y + 1) * kSide; ++v) {
      triangles.push_back({v, v + 1, v + kSide});
      triangles.push_back({v + 1, v + kSide + 1, v + kSide});
    }
  }
  const std::array<Surface, 1> sheet{Surface{.triangles = triangles, .vertex_count = kSide * kSide}};
  const auto separation = [&] {
    Separation made(triangles, sheet);
    made.watch(std::vector<TrianglePair>{}, start);
    return made;
  };
  Separation remembers = separation();
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Vec3> x_t0 = start, x_t1 = start;
  std::size_t max_count = 0, min_count = 1000;
  for (int trial = 0; trial < 60; ++trial) {
    const auto v = static_cast<std::size_t>(engine() % start.size());
    (trial % 3 == 0 ? x_t0 : x_t1)[v] = start[v] + Vec3(number(engine), number(engine), number(engine));
    if (trial % 5 == 0) x_t0[v] = x_t1[v] = start[v];
    const std::span<const CornerPair> found = remembers.find_failing(x_t0, x_t1);
    Separation another = separation();
    EXPECT_TRUE(std::ranges::equal(found, another.find_failing(x_t0, x_t1))) << "look " << trial;
    max_count = std::max(max_count, found.size());
    min_count = std::min(min_count, found.size());
  }
  EXPECT_GT(max_count, min_count);
}

// Two layers turn together, so that no plane of constant direction separates them.
TEST(Separation, TestsPairsAgainWithOtherPlanesOnlyIfItForgetsItsTests) {
  const std::vector<Vec3> x{{-1, -1, 0.01}, {1, -1, 0.01}, {0, 1, 0.01}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  std::vector<Vec3> end;
  for (const Vec3& place : x) end.push_back(Eigen::AngleAxisd(0.5, Vec3::UnitY()) * place);
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const std::vector<TrianglePair> pairs{{0, 1}};
  Separation separation(triangles, {});
  separation.watch(pairs, x);
  const auto count_failing = [&](PlaneKinds which) {
    return separation.find_failing(x, end, nullptr, nullptr, which).size();
  };
  EXPECT_EQ(count_failing(PlaneKinds::turning), 0u);
  EXPECT_EQ(count_failing(PlaneKinds::constant), 0u);
  separation.forget_tests();
  EXPECT_EQ(count_failing(PlaneKinds::constant), 1u);
}

TEST(Separation, PairsThatWouldMeetArePushedApart) {
  for (double motion : {0.01, 0.05, 0.2}) {
    IsolatedPairs pairs = random_pairs(200, motion, 3);
    const std::set<Index> before = failing(pairs);
    ASSERT_FALSE(before.empty());
    const std::vector<Vec3> wanted = pairs.x_t1;
    Separation separation = pairs.separation();
    EXPECT_TRUE(separation.enforce(pairs.x_t0, pairs.x_t1, pairs.movable).separated);
    EXPECT_TRUE(failing(pairs).empty());
    EXPECT_TRUE(meeting(pairs).empty());

    // Only vertices of failing pairs were moved.
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_TRUE(wanted[i] == pairs.x_t1[i] || before.contains(static_cast<Index>(i / 6)));
  }
}

// A triangle slides by 25 mm across the border of a facet, and ends 0.01 mm below it. (A push along the line between
// the closest points of the start would move it back by 17 mm.)
TEST(Separation, PushesAlongTheShortestOfTheDirectionsThatSeparateAtTheStart) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const std::vector<TrianglePair> pairs{{0, 1}};
  const std::vector<Vec3> x_t0{{0, 0, 1e-3},      {-0.01, 0.01, 1e-3}, {-0.01, -0.01, 1e-3},
                               {0.008, -0.02, 0}, {0.014, -0.02, 0},   {0.011, 0.04, 0}};
  std::vector<Vec3> x_t1 = x_t0;
  for (std::size_t v = 0; v < 3; ++v) x_t1[v] += Vec3(0.025, 0, -1.01e-3);
  const std::vector<Vec3> wanted = x_t1;
  Separation separation(triangles, {});
  separation.watch(pairs, x_t0);
  const std::vector<std::uint8_t> movable{kFree, kFree, kFree, kFixed, kFixed, kFixed};
  EXPECT_TRUE(separation.enforce(x_t0, x_t1, movable).separated);
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_GT((x_t1[v] - wanted[v]).norm(), 0.01e-3);
    EXPECT_LT((x_t1[v] - wanted[v]).norm(), 0.01e-3 + 1.01 * numerics.separation.restored_gap);
  }
}

TEST(Separation, PushingAPieceOfRopeOffATriangleKeepsTheMomentum) {
  const std::vector<Triangle> triangles{{0, 1, 1}, {2, 3, 4}};
  const std::vector<TrianglePair> pairs{{0, 1}};
  const std::vector<Vec3> x_t0{{-0.1, 0, 0.01}, {0.1, 0, 0.01}, {-0.2, -0.2, 0}, {0.2, -0.2, 0}, {0, 0.2, 0}};
  std::vector<Vec3> x_t1 = x_t0;
  for (const std::size_t end : {0, 1}) x_t1[end].z() = -0.02;
  std::vector<Vec3> pushed = x_t1;
  Separation separation(triangles, {});
  separation.watch(pairs, x_t0);
  ASSERT_TRUE(separation.enforce(x_t0, pushed, std::vector<std::uint8_t>(x_t0.size(), kFree)).separated);
  Vec3 gain = Vec3::Zero();  // all masses are equal
  for (std::size_t v = 0; v < pushed.size(); ++v) gain += pushed[v] - x_t1[v];
  EXPECT_GT(pushed[0].z(), x_t1[0].z());
  EXPECT_LT(gain.norm(), 1e-12);
}

TEST(Separation, WhatCannotMoveIsNotMoved) {
  // One side of each pair is an obstacle, which cannot be moved.
  IsolatedPairs pairs = random_pairs(200, 0.05, 4);
  for (std::size_t i = 0; i < pairs.movable.size(); ++i) pairs.movable[i] = i % 6 < 3;
  const std::vector<Vec3> wanted = pairs.x_t1;
  Separation separation = pairs.separation();
  EXPECT_TRUE(separation.enforce(pairs.x_t0, pairs.x_t1, pairs.movable).separated);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!pairs.movable[i]) {
      EXPECT_EQ(pairs.x_t1[i], wanted[i]);
    }
  }
  EXPECT_TRUE(meeting(pairs).empty());
}

TEST(Separation, PairsThatKeepTheirDistanceAreLeftAlone) {
  IsolatedPairs pairs = random_pairs(50, 0, 5);
  for (Vec3& x : pairs.x_t1) x += Vec3(0.3, 0.1, -0.2);  // all move together
  const std::vector<Vec3> wanted = pairs.x_t1;
  Separation separation = pairs.separation();
  EXPECT_TRUE(separation.enforce(pairs.x_t0, pairs.x_t1, pairs.movable).separated);
  EXPECT_EQ(pairs.x_t1, wanted);
}

TEST(Separation, SaysWhichPairIsStuckWhereThereIsNoRoom) {
  // A triangle is between two plates that pass through each other.
  const auto triangle_at = [](double z) { return std::vector<Vec3>{{-1, -1, z}, {1, -1, z}, {0, 1, z}}; };
  const auto three = [&](double low, double middle, double high) {
    std::vector<Vec3> x;
    for (double z : {low, middle, high})
      for (const Vec3& corner : triangle_at(z)) x.push_back(corner);
    return x;
  };
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const std::vector<TrianglePair> pairs{{0, 1}, {1, 2}};
  const std::vector<Vec3> x_t0 = three(0, 0.1, 0.2), wanted = three(0.15, 0.1, 0.05);
  const std::vector<std::uint8_t> movable{0, 0, 0, 1, 1, 1, 0, 0, 0};
  std::vector<Vec3> x_t1 = wanted;
  Separation separation(triangles, {});
  separation.watch(pairs, x_t0);
  const SeparationReport report = separation.enforce(x_t0, x_t1, movable);
  EXPECT_FALSE(report.separated);
  EXPECT_TRUE(report.unseparated_pair == (CornerPair{triangles[0], triangles[1]}) ||
              report.unseparated_pair == (CornerPair{triangles[1], triangles[2]}));
  for (std::size_t i : {0u, 1u, 2u, 6u, 7u, 8u}) EXPECT_EQ(x_t1[i], wanted[i]);

  // If some clearance remains between the plates, the triangle moves there.
  x_t1 = three(0.15, 0.1, 0.16);
  EXPECT_TRUE(separation.enforce(x_t0, x_t1, movable).separated);
  for (std::size_t i : {3u, 4u, 5u}) {
    EXPECT_GT(x_t1[i].z(), 0.15);
    EXPECT_LT(x_t1[i].z(), 0.16);
  }
}

TEST(ClosestFeatures, AreThoseOfADenseSearch) {
  const IsolatedPairs pairs = random_pairs(20, 0, 6);
  for (const TrianglePair& pair : pairs.pairs) {
    const Triangle &a = pairs.triangles[pair.a], &b = pairs.triangles[pair.b];
    const ClosestFeatures found = closest_features({a, b}, pairs.x_t0);
    const double distance = std::sqrt(found.points.distance_sq);
    Vec3 difference = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) difference += found.points.weights[k] * pairs.x_t0[found.vertices[k]];
    EXPECT_LT((difference - found.points.difference).norm(), 1e-14);
    EXPECT_NEAR(difference.norm(), distance, 1e-14);

    constexpr int kCuts = 24;
    const auto point = [&](const Triangle& t, int i, int j) {
      const Vec3 &p = pairs.x_t0[t[0]], &q = pairs.x_t0[t[1]], &r = pairs.x_t0[t[2]];
      return Vec3(p + double(i) / kCuts * (q - p) + double(j) / kCuts * (r - p));
    };
    double minimum = 1;
    for (int i = 0; i <= kCuts; ++i)
      for (int j = 0; i + j <= kCuts; ++j)
        for (int k = 0; k <= kCuts; ++k)
          for (int l = 0; k + l <= kCuts; ++l) minimum = std::min(minimum, (point(a, i, j) - point(b, k, l)).norm());
    EXPECT_LE(distance, minimum + 1e-14);
    // Tolerance: on each triangle, a sample is at most 1/kCuts of an edge of 0.17 m away from the closest point.
    EXPECT_GT(distance, minimum - 2 * 0.17 / kCuts);
  }
}

}  // namespace
}  // namespace weft::collision
