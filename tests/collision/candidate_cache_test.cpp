// Tests of CandidateCache. Its pairs are compared with brute force. It covers a start or end of a step if its pairs are
// complete for this start or end.
#include "physics/collision/candidate_cache.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "collision/hierarchy/test_meshes.hpp"
#include "physics/collision/proximity/closest_points.hpp"
#include "physics/collision/proximity/features.hpp"

namespace weft::collision {
namespace {

constexpr double kReach = 0.01;  // detection distance [m]

Vec3 random_in_ball(std::mt19937& generator, double radius) {
  std::uniform_real_distribution<double> unit(-1, 1);
  for (;;) {
    const double a = unit(generator), b = unit(generator), c = unit(generator);
    if (const Vec3 v(a, b, c); v.norm() <= 1) return radius * v;
  }
}

/// Two sheets of n × n squares at the heights 0 and `gap` [m], and an obstacle of one triangle at the height −`gap`.
struct Layers {
  Bodies bodies;
  std::vector<Vec3> x;

  explicit Layers(int n, double gap) {
    for (int layer = 0; layer < 2; ++layer) {
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) x.emplace_back(0.03 * i, 0.03 * j, gap * layer);
      bodies.add(testing::grid_triangles(n + 1), (n + 1) * (n + 1), {.deformable = true, .thickness = 0.004});
    }
    for (const Vec3& corner : {Vec3(-1, -1, -gap), Vec3(2, -1, -gap), Vec3(0, 2, -gap)}) x.push_back(corner);
    bodies.add(std::vector<Triangle>{{0, 1, 2}}, 3, {});
  }

  std::vector<Vec3> moved_by(std::mt19937& generator, double max_distance) const {
    std::vector<Vec3> moved = x;
    for (Vec3& place : moved) place += random_in_ball(generator, max_distance);
    return moved;
  }
};

std::set<std::pair<Index, Index>> set_of(const PairList& pairs) {
  std::set<std::pair<Index, Index>> set;
  for (const TrianglePair& pair : pairs) set.emplace(std::min(pair.a, pair.b), std::max(pair.a, pair.b));
  return set;
}

/// Pairs of triangles without a common vertex in which a vertex of one is closer than `reach` [m] to the other one.
std::set<std::pair<Index, Index>> near(std::span<const Triangle> triangles, std::span<const Vec3> x, double reach) {
  std::set<std::pair<Index, Index>> found;
  for (std::size_t a = 0; a < triangles.size(); ++a)
    for (std::size_t b = 0; b < triangles.size(); ++b) {
      const Triangle& face = triangles[b];
      const auto shared = [&](Index v) { return has_vertex(face, v); };
      if (a == b || std::ranges::any_of(triangles[a], shared)) continue;
      for (Index v : triangles[a])
        if (closest_vertex_face(x[v], x[face[0]], x[face[1]], x[face[2]]).distance_sq < reach * reach)
          found.emplace(std::min(a, b), std::max(a, b));
    }
  return found;
}

TEST(CandidateCache, EveryPairWithinReachAtACoveredEndWasCollected) {
  const Layers layers(4, 0.5 * kReach);
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  const std::set<std::pair<Index, Index>> collected = set_of(cache.collect(layers.x, layers.x).apart);
  std::mt19937 generator(1);
  int covered = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<Vec3> end = layers.moved_by(generator, trial % 2 == 0 ? 0.5 * kReach : 2 * kReach);
    if (!cache.covers_end(end)) continue;
    ++covered;
    for (const auto& pair : near(layers.bodies.triangles(), end, kReach)) EXPECT_TRUE(collected.contains(pair));
  }
  EXPECT_GE(covered, 100);  // all ends within 0.5 kReach are covered
}

// The lower sheet is folded: its columns 3 and 4 are 3 mm below its columns 1 and 0.
TEST(CandidateCache, ASheetMeetsItself) {
  Layers layers(4, 0.5 * kReach);
  for (int j = 0; j <= 4; ++j)
    for (int i = 3; i <= 4; ++i) layers.x[i + 5 * j] = layers.x[4 - i + 5 * j] + Vec3(0, 0.001, -0.3 * kReach);
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  const auto collected = set_of(cache.collect(layers.x, layers.x).apart);
  const auto of_itself = near(layers.bodies.triangles().first(32), layers.x, kReach);
  EXPECT_GT(of_itself.size(), 20U);
  for (const auto& pair : of_itself) EXPECT_TRUE(collected.contains(pair));
}

TEST(CandidateCache, FeaturesWithinReachAtACoveredStartWereWithinTheRadius) {
  const Layers layers(3, kReach);
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  cache.collect(layers.x, layers.x);
  const auto then = near(layers.bodies.triangles(), layers.x, cache.radius());
  std::mt19937 generator(2);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Vec3> start = layers.moved_by(generator, 0.5 * kReach);
    ASSERT_TRUE(cache.covers_start(start));
    for (const auto& pair : near(layers.bodies.triangles(), start, kReach)) EXPECT_TRUE(then.contains(pair));
  }
}

// If the cloth rests, the Verlet margin is half the detection distance. Without reuse of candidate pairs, and in a fast
// step, there is no Verlet margin: the cache covers only the start of the search itself.
TEST(CandidateCache, TheVerletMarginOfRestingClothIsHalfTheDetectionDistance) {
  const Layers layers(2, kReach);
  std::vector<Vec3> inside = layers.x, outside = layers.x, fast = layers.x;
  inside[3].z() += 0.499 * kReach;
  outside[3].z() += 0.501 * kReach;
  fast[5].x() += 0.6 * kReach;

  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  EXPECT_FALSE(cache.covers_start(layers.x));  // no pairs have been collected
  cache.collect(layers.x, layers.x);
  EXPECT_TRUE(cache.covers_start(inside));
  EXPECT_FALSE(cache.covers_start(outside));
  cache.collect(layers.x, fast);
  EXPECT_TRUE(cache.covers_start(layers.x));
  EXPECT_FALSE(cache.covers_start(inside));
  cache.invalidate();
  EXPECT_FALSE(cache.covers_start(layers.x));

  CandidateCache every_step(layers.bodies, {.reuse = false}, layers.x, kReach);
  every_step.collect(layers.x, layers.x);
  EXPECT_FALSE(every_step.covers_start(inside));
}

TEST(CandidateCache, CoversEndsWithinTheMarginOfThePredictedEnd) {
  const Layers layers(2, kReach);
  std::vector<Vec3> to = layers.x;
  to[4].x() += 3 * kReach;  // a fast step: the margin is half the detection distance
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  cache.collect(layers.x, to);
  std::vector<Vec3> end = to;
  end[4].x() += 0.49 * kReach;
  EXPECT_TRUE(cache.covers_end(end));
  end[4].x() += 0.02 * kReach;
  EXPECT_FALSE(cache.covers_end(end));
  end[4] = layers.x[4] + Vec3(1.5 * kReach, 0, 0);
  EXPECT_FALSE(cache.covers_end(end));  // between start and predicted end
  cache.invalidate();
  EXPECT_FALSE(cache.covers_end(to));
}

// With diagonal directions, the margin limits the length of a displacement; otherwise, it limits its components along
// the axes.
TEST(CandidateCache, WithMoreDirectionsThanSixAnEndIsCoveredWithinABall) {
  const Layers layers(2, kReach);
  std::vector<Vec3> to = layers.x;
  to[4].x() += 3 * kReach;
  for (const int directions : {6, 18, 26}) {
    CandidateCache cache(layers.bodies, {.broad_phase = {.directions = directions}}, layers.x, kReach);
    cache.collect(layers.x, to);
    std::vector<Vec3> end = to;
    end[4].x() += 0.49 * kReach;
    EXPECT_TRUE(cache.covers_end(end)) << directions;
    end[4] = to[4] + Vec3::Constant(0.4 * kReach);
    EXPECT_EQ(cache.covers_end(end), directions == 6) << directions;
  }
}

// The response pushes particle 4 away from its end. The cache then covers all positions of this particle between its
// start and the pushed end, and its former end. With `all`, this holds for every particle.
TEST(CandidateCache, CoversPositionsBetweenStartAndEndOfPushedParticles) {
  const Layers layers(2, kReach);
  std::vector<Vec3> to = layers.x;
  for (Vec3& x : to) x.x() += 3 * kReach;
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  cache.collect(layers.x, to);
  std::vector<Vec3> pushed = to, half = to, other_half = to;
  pushed[4].z() += kReach;
  half[4] = 0.5 * (layers.x[4] + pushed[4]);
  other_half[5] = 0.5 * (layers.x[5] + to[5]);
  cache.collect_more(layers.x, pushed, false);
  for (const auto* end : {&to, &pushed, &half}) EXPECT_TRUE(cache.covers_end(*end));
  EXPECT_FALSE(cache.covers_end(other_half));
  cache.collect_more(layers.x, pushed, true);
  for (const auto* end : {&to, &pushed, &half, &other_half}) EXPECT_TRUE(cache.covers_end(*end));
  EXPECT_TRUE(cache.covers_end(layers.x));
}

// Compares the pairs with brute force. The ends lie between the start and `far`, with random displacements below the
// margin, which is half the detection distance.
TEST(CandidateCache, EveryPairWithinReachAtAnEndBetweenIsCollectedThen) {
  const Layers layers(4, 0.5 * kReach);
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  std::mt19937 generator(3);
  std::vector<Vec3> far = layers.x;
  for (std::size_t v = 0; v < 25; ++v) far[v] += Vec3(0.05, -0.03, 0.02);  // the lower sheet crosses the upper one
  cache.collect(layers.x, far);
  const std::set<std::pair<Index, Index>> collected = set_of(cache.collect_more(layers.x, far, true).apart);
  std::uniform_real_distribution<double> fraction(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec3> end = layers.x;
    for (std::size_t v = 0; v < end.size(); ++v)
      end[v] += fraction(generator) * (far[v] - layers.x[v]) + random_in_ball(generator, 0.49 * kReach);
    ASSERT_TRUE(cache.covers_end(end));
    for (const auto& pair : near(layers.bodies.triangles(), end, kReach)) EXPECT_TRUE(collected.contains(pair));
  }
}

TEST(CandidateCache, WhatIsNotWantedIsLeftOut) {
  const Layers layers(2, 0.5 * kReach);
  const auto obstacle = static_cast<Index>(layers.bodies.triangles().size() - 1);
  const auto collected = [&](bool self, bool obstacles) {
    CandidateCache cache(layers.bodies, {.self = self, .obstacles = obstacles}, layers.x, kReach);
    return set_of(cache.collect(layers.x, layers.x).apart);
  };
  const auto with_obstacle = [&](const auto& pair) { return pair.second == obstacle; };
  const auto cloth = collected(true, false), obstacles = collected(false, true), both = collected(true, true);
  EXPECT_TRUE(!cloth.empty() && std::ranges::none_of(cloth, with_obstacle));
  EXPECT_TRUE(!obstacles.empty() && std::ranges::all_of(obstacles, with_obstacle));
  EXPECT_EQ(both.size(), cloth.size() + obstacles.size());
  EXPECT_TRUE(collected(false, false).empty());
}

// The added obstacle (body 3) is clear while it is at least two detection distances from the cloth along the x axis.
TEST(CandidateCache, AnObstacleBeyondTheClothChangesNothingUntilItComesNear) {
  Layers layers(4, 0.5 * kReach);
  CandidateCache alone(layers.bodies, {}, layers.x, kReach);
  const std::set<std::pair<Index, Index>> pairs = set_of(alone.collect(layers.x, layers.x).apart);
  for (const Vec3& corner : {Vec3(3, 0, 0), Vec3(3, 1, 0), Vec3(3, 0, 1)}) layers.x.push_back(corner);
  layers.bodies.add(std::vector<Triangle>{{0, 1, 2}}, 3, {});
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  const auto with_obstacle_at = [&](double x) {
    std::vector<Vec3> moved = layers.x;
    for (std::size_t corner = moved.size() - 3; corner < moved.size(); ++corner) moved[corner].x() = x;
    return moved;
  };
  // The obstacle moves by 2 m. As it is clear, the step counts as slow, and the Verlet margin stays.
  EXPECT_EQ(set_of(cache.collect(layers.x, with_obstacle_at(1)).apart), pairs);
  EXPECT_EQ(cache.radius(), alone.radius());
  EXPECT_TRUE(cache.is_clear(3));
  EXPECT_FALSE(cache.is_clear(2));
  EXPECT_TRUE(cache.covers_start(with_obstacle_at(0.2)));
  EXPECT_TRUE(cache.covers_end(with_obstacle_at(500)));
  // The cloth extends from x = 0 to x = 0.12 m. The obstacle must stay at x ≥ 0.12 m plus two detection distances.
  EXPECT_TRUE(cache.covers_end(with_obstacle_at(0.12 + 2.001 * kReach)));
  EXPECT_FALSE(cache.covers_end(with_obstacle_at(0.12 + 1.999 * kReach)));
  EXPECT_FALSE(cache.covers_start(with_obstacle_at(-1)));
  cache.collect(layers.x, with_obstacle_at(0.1));
  EXPECT_FALSE(cache.is_clear(3));
}

// The cache does not refit the bounds of an obstacle that stands still. It must refit them after the obstacle moves.
TEST(CandidateCache, AnObstacleThatHasMovedIsFoundWhereItIs) {
  Layers layers(2, 0.5 * kReach);
  CandidateCache cache(layers.bodies, {}, layers.x, kReach);
  const std::size_t near_obstacle = cache.collect(layers.x, layers.x).apart.size();
  std::vector<Vec3> away = layers.x;
  for (std::size_t v = away.size() - 3; v < away.size(); ++v) away[v].z() -= 1;
  const std::size_t without = cache.collect(away, away).apart.size();
  EXPECT_LT(without, near_obstacle);
  EXPECT_EQ(cache.collect(layers.x, layers.x).apart.size(), near_obstacle);
  EXPECT_EQ(cache.collect(layers.x, layers.x).apart.size(), near_obstacle);
}

TEST(Bodies, TrianglesAreNumberedThroughAllBodies) {
  const Layers layers(1, 0.1);
  EXPECT_EQ(layers.bodies.size(), 3U);
  EXPECT_EQ(layers.bodies.vertex_count(), 11);
  EXPECT_EQ(layers.bodies.deformable().size(), 2U);
  EXPECT_EQ(layers.bodies.triangles()[2], (Triangle{4, 5, 7}));
  EXPECT_EQ(layers.bodies.surfaces()[2].first_triangle, 4);
  EXPECT_EQ(layers.bodies.surfaces()[2].triangles[0], (Triangle{8, 9, 10}));
  EXPECT_EQ(layers.bodies.body_of(7), 1U);
  EXPECT_EQ(layers.bodies.triangle_of({7, 6, 4}), 1);  // the second triangle of the second sheet
  EXPECT_EQ(layers.bodies.triangle_of({5, 7, 7}), 0);  // the first triangle with the edge from 5 to 7
}

}  // namespace
}  // namespace weft::collision
