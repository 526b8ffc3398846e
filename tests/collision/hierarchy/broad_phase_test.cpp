// Compares the pairs of the broad phase, for each of its options, with brute force in every step of a motion.
#include "physics/collision/hierarchy/broad_phase.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "collision/hierarchy/feature_distance.hpp"
#include "collision/hierarchy/test_motions.hpp"
#include "core/error.hpp"
#include "physics/collision/hierarchy/kdop.hpp"

namespace weft::collision {
namespace {

using testing::FoldingSlidingFlying;
using testing::kMargin;
using testing::MovingScene;
using Pairs = std::set<TrianglePair>;

constexpr int kSteps = 40;

/// [0]: pairs without a common vertex; [1]: pairs with one.
using BothLists = std::array<Pairs, 2>;

/// All pairs of triangles, with at most one common vertex, whose moving k-DOPs overlap; uses no hierarchy.
template <int K>
BothLists brute_force(const MovingScene& scene, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                      double margin = kMargin) {
  std::vector<MovingKDop<K>> bounds;
  for (const Triangle& t : scene.triangles) {
    const auto at = [&](std::size_t c) {
      const auto v = static_cast<std::size_t>(t[c]);
      return moving_point<K>(x_t0[v], x_t1[v], x_t1[v], margin);
    };
    bounds.push_back(at(0));
    bounds.back().join(at(1));
    bounds.back().join(at(2));
  }
  BothLists found;
  for (std::size_t a = 0; a < bounds.size(); ++a)
    for (std::size_t b = a + 1; b < bounds.size(); ++b)
      if (bounds[a].overlaps(bounds[b]))
        if (const std::size_t shared = testing::shared_count(scene.triangles[a], scene.triangles[b]); shared < 2)
          found[shared].insert({static_cast<Index>(a), static_cast<Index>(b)});
  return found;
}

BothLists all_pairs(BroadPhase& broad_phase, std::size_t surfaces) {
  CandidatePairs candidates;
  for (std::size_t a = 0; a < surfaces; ++a) {
    broad_phase.self_pairs(a, candidates);
    for (std::size_t b = a + 1; b < surfaces; ++b) broad_phase.pairs(a, b, candidates);
  }
  const BothLists found{Pairs(candidates.apart.begin(), candidates.apart.end()),
                        Pairs(candidates.one_shared.begin(), candidates.one_shared.end())};
  EXPECT_EQ(found[0].size(), candidates.apart.size()) << "a pair is listed twice";
  EXPECT_EQ(found[1].size(), candidates.one_shared.size()) << "a pair is listed twice";
  return found;
}

/// Combinations of options with which the pairs must equal those of brute force.
std::vector<BroadPhaseOptions> exact_options(int directions) {
  std::vector<BroadPhaseOptions> all;
  for (const int children : {2, 4, 8})
    for (const int leaf : {1, 3, 8})
      for (const bool longer : {false, true})
        for (const bool list : {false, true}) {
          BroadPhaseOptions options;
          options.directions = directions;
          options.children = children;
          options.leaf = leaf;
          options.open_longer_side = longer;
          options.separation_list = list;
          all.push_back(options);
        }
  return all;
}

template <class K>
class BroadPhasePairs : public ::testing::Test {};
using AllK =
    ::testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(BroadPhasePairs, AllK);

TYPED_TEST(BroadPhasePairs, OfMovingSurfacesEqualBruteForceAtEveryStepForAllTreesOrdersAndSeparationLists) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  const std::vector<BroadPhaseOptions> settings = exact_options(TypeParam::value);
  std::vector<BroadPhase> broad_phases;
  for (const BroadPhaseOptions& options : settings) broad_phases.emplace_back(surfaces, motion.at(0), options);

  std::size_t min_count = 1000000, max_count = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Vec3> x_t0 = motion.at(step), x_t1 = motion.at(step + 1);
    const BothLists expected = brute_force<TypeParam::value>(motion.scene(), x_t0, x_t1);
    min_count = std::min(min_count, expected[0].size());
    max_count = std::max(max_count, expected[0].size());
    for (std::size_t i = 0; i < settings.size(); ++i) {
      for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phases[i].refit(s, {x_t0, x_t1}, kMargin);
      EXPECT_EQ(all_pairs(broad_phases[i], surfaces.size()), expected)
          << "step " << step << ", children " << settings[i].children << ", leaf " << settings[i].leaf << ", longer "
          << settings[i].open_longer_side << ", list " << settings[i].separation_list;
    }
  }
  // The number of pairs varies during the motion.
  EXPECT_GT(max_count, 2 * min_count);
}

/// Every pair whose bounds with this margin [m] overlap must be listed. It is below kMargin by more than the rounding
/// errors of float.
constexpr double kRequiredMargin = kMargin - 2e-6;

TYPED_TEST(BroadPhasePairs, WithVelocityConesHoldAllOfBruteForceAtEveryStep) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  for (const bool list : {false, true}) {
    BroadPhaseOptions options;
    options.directions = TypeParam::value;
    options.children = list ? 8 : 4;
    options.velocity_cones = true;
    options.separation_list = list;
    BroadPhase broad_phase(surfaces, motion.at(0), options);
    std::size_t kept = 0;
    for (int step = 0; step < kSteps; ++step) {
      // The surfaces stand still in the last four of every eight steps.
      const auto at = [&](int s) { return motion.at(s % 8 < 4 ? s : s - s % 4); };
      const std::vector<Vec3> x_t0 = at(step), x_t1 = at(step + 1);
      for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phase.refit(s, {x_t0, x_t1}, kMargin);
      const BothLists required = brute_force<TypeParam::value>(motion.scene(), x_t0, x_t1, kRequiredMargin);
      const BothLists allowed = brute_force<TypeParam::value>(motion.scene(), x_t0, x_t1, kMargin * 1.13);
      const BothLists found = all_pairs(broad_phase, surfaces.size());
      for (const std::size_t l : {0U, 1U}) {
        EXPECT_TRUE(std::ranges::includes(found[l], required[l])) << step;
        EXPECT_TRUE(std::ranges::includes(allowed[l], found[l])) << step;
        kept += found[l].size() - required[l].size();
      }
    }
    EXPECT_GT(kept, 0U) << "no bound was ever left as it was";
  }
}

/// Pairs without a common vertex whose features are closer than `reach` [m] at one of 17 times of the motion.
Pairs near_during_motion(const MovingScene& scene, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                         double reach) {
  Pairs near;
  for (int k = 0; k <= 16; ++k) {
    std::vector<Vec3> x(x_t0.size());
    for (std::size_t v = 0; v < x.size(); ++v) x[v] = x_t0[v] + k / 16.0 * (x_t1[v] - x_t0[v]);
    for (std::size_t a = 0; a < scene.triangles.size(); ++a)
      for (std::size_t b = a + 1; b < scene.triangles.size(); ++b)
        if (testing::shared_count(scene.triangles[a], scene.triangles[b]) == 0 &&
            testing::feature_distance(scene.triangles[a], scene.triangles[b], x) < reach)
          near.insert({static_cast<Index>(a), static_cast<Index>(b)});
  }
  return near;
}

// The pairs must be complete for trajectories on which each vertex starts within the margin of x_t0, and ends within
// the margin of the box from `low` to `high`.
TYPED_TEST(BroadPhasePairs, HoldAllThatComeNearOnTheWayToAnywhereBetweenTwoCorners) {
  const FoldingSlidingFlying motion(5);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  BroadPhaseOptions options;
  options.directions = TypeParam::value;
  BroadPhase broad_phase(surfaces, motion.at(0), options);
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t near_of_all = 0;
  for (int step = 0; step < kSteps; step += 4) {
    const std::vector<Vec3> x_t0 = motion.at(step), one = motion.at(step + 1), other = motion.at(step + 3);
    std::vector<Vec3> low, high, start, end;
    for (std::size_t v = 0; v < x_t0.size(); ++v) {
      low.push_back(one[v].cwiseMin(other[v]));
      high.push_back(one[v].cwiseMax(other[v]));
      const auto off = [&] { return 2 * unit(generator) - 1; };
      const double fraction = unit(generator);
      start.push_back(x_t0[v] + kMargin * Vec3(off(), off(), off()));
      end.push_back(low[v] + fraction * (high[v] - low[v]) + kMargin * Vec3(off(), off(), off()));
    }
    for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phase.refit(s, Motion(x_t0, low, high), kMargin);
    const Pairs found = all_pairs(broad_phase, surfaces.size())[0];
    const Pairs meeting = near_during_motion(motion.scene(), start, end, 1e-4);
    EXPECT_TRUE(std::ranges::includes(found, meeting)) << step;
    near_of_all += meeting.size();
  }
  EXPECT_GT(near_of_all, 20U);
}

TEST(BroadPhase, DoesNotListWhatMovesAlongWithEachOther) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  const std::vector<Vec3> x = motion.at(0);
  std::vector<Vec3> far = x;
  for (Vec3& place : far) place += Vec3(3, -2, 5);
  BroadPhase broad_phase(surfaces, x);
  const auto pairs_to = [&](std::span<const Vec3> x_t1) {
    for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phase.refit(s, {x, x_t1}, kMargin);
    return all_pairs(broad_phase, surfaces.size());
  };
  EXPECT_EQ(pairs_to(far), pairs_to(x));
}

TEST(BroadPhase, LeavesOutPairsWithACommonVertexWhereTheyAreNotWanted) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  BroadPhase all(surfaces, motion.at(0)), apart(surfaces, motion.at(0), {.one_shared = false});
  EXPECT_FALSE(all_pairs(all, surfaces.size())[1].empty());
  EXPECT_TRUE(all_pairs(apart, surfaces.size())[1].empty());
  EXPECT_EQ(all_pairs(apart, surfaces.size())[0], all_pairs(all, surfaces.size())[0]);
}

TEST(BroadPhase, WithASeparationListListsTheSamePairsAgainWhenAskedTwice) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  BroadPhaseOptions options;
  options.separation_list = true;
  BroadPhase broad_phase(surfaces, motion.at(0), options);
  const BothLists first = all_pairs(broad_phase, surfaces.size());
  EXPECT_EQ(all_pairs(broad_phase, surfaces.size()), first);
}

// Normal cones skip flat regions. When a region folds, its pairs are listed once each. When it becomes flat again, a
// search with the separation list does not skip it, so this search may list more pairs.
TEST(BroadPhase, WithASeparationListAndNormalConesListsEachPairOnce) {
  const FoldingSlidingFlying motion(9);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  BroadPhaseOptions options;
  options.normal_cones = true;
  BroadPhase plain(surfaces, motion.at(0), options);
  options.separation_list = true;
  BroadPhase listed(surfaces, motion.at(0), options);
  constexpr int kStill = 6;  // number of steps without motion at the start
  for (int step = 0; step < kStill + kSteps; ++step) {
    const std::vector<Vec3> x_t0 = motion.at(std::max(0, step - kStill)),
                            x_t1 = motion.at(std::max(0, step + 1 - kStill));
    for (BroadPhase* broad_phase : {&plain, &listed})
      for (std::size_t s = 0; s < surfaces.size(); ++s) broad_phase->refit(s, {x_t0, x_t1}, kMargin);
    const BothLists required = all_pairs(plain, surfaces.size()), found = all_pairs(listed, surfaces.size());
    for (const std::size_t l : {0U, 1U}) EXPECT_TRUE(std::ranges::includes(found[l], required[l])) << step;
  }
}

TEST(BroadPhase, RefusesKindsOfTreesThatItDoesNotHave) {
  const FoldingSlidingFlying motion(3);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  BroadPhaseOptions options;
  options.directions = 8;
  EXPECT_THROW(BroadPhase(surfaces, motion.at(0), options), Error);
  options = {};
  options.children = 9;
  EXPECT_THROW(BroadPhase(surfaces, motion.at(0), options), Error);
  options = {};
  options.leaf = 9;
  EXPECT_THROW(BroadPhase(surfaces, motion.at(0), options), Error);
}

}  // namespace
}  // namespace weft::collision
