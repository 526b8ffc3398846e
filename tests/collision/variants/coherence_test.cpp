// Compares reused detection results with brute force and with fresh searches, step by step.
#include "physics/collision/variants/coherence.hpp"

#include <gtest/gtest.h>

#include <set>

#include "collision/hierarchy/test_motions.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

using testing::folded_sheet;
using testing::MovingScene;
using testing::TestMesh;
using Pairs = std::set<TrianglePair>;

constexpr double kWidestReach = 0.02, kBudget = 0.01;  // see CoherenceParameters [m]
constexpr int kSheet = 15;

/// A folded sheet, and a second sheet above it, fall fast together and flutter slightly. A third sheet rises from
/// below.
class Falling {
 public:
  Falling() {
    const TestMesh sheet = folded_sheet(kSheet, 2, 0.015);
    for (int s = 0; s < 3; ++s) {
      scene_.add(sheet);
      for (const Vec3& p : sheet.x) rest_.push_back(p + Vec3{0.1 * s, 0.05 * s, s == 2 ? -1.0 : 0.05 * s});
    }
  }
  const MovingScene& scene() const { return scene_; }
  std::vector<Vec3> at(int step) const {
    std::vector<Vec3> x = rest_;
    for (std::size_t v = 0; v < x.size(); ++v) {
      const bool third = v >= 2 * kSheet * kSheet;
      x[v] += third ? Vec3{0, 0, 0.03 * step} : Vec3{0.02, 0, -0.01} * step;
      x[v][2] += 0.002 * std::sin(0.5 * step + 5 * rest_[v][0] + 3 * rest_[v][1]);
    }
    return x;
  }

 private:
  MovingScene scene_;
  std::vector<Vec3> rest_;
};

ClosestPoints of_features(const Proximity& p, std::span<const Vec3> x) {
  const auto at = [&](std::size_t i) -> const Vec3& { return x[p.vertices[i]]; };
  return p.kind == ProximityKind::vertex_face ? closest_vertex_face(at(0), at(1), at(2), at(3))
                                              : closest_edge_edge(at(0), at(1), at(2), at(3));
}

/// The closest point on side a, by its weights.
Vec3 place(const Proximity& p, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    if (p.weights[i] > 0) sum += p.weights[i] * x[p.vertices[i]];
  return sum;
}

const std::vector<SurfacePair> kAllPairs{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

class CoherentDetectionTest : public ::testing::Test {
 protected:
  /// Broad and narrow phase of a search. The detection uses `kept_`; the comparison uses `fresh_`.
  struct Search {
    BroadPhase broad_phase;
    ProximityFinder finder;
  };
  Search make_search() const {
    return {BroadPhase(surfaces_, motion_.at(0)),
            ProximityFinder(motion_.scene().triangles, static_cast<Index>(motion_.at(0).size()))};
  }
  CoherentDetection make_detection(const std::vector<SurfacePair>& wanted) const {
    return {surfaces_, wanted, motion_.at(0), {.detection_distance = kWidestReach, .budget = kBudget}};
  }
  int update(CoherentDetection& detection, const std::vector<Vec3>& x_t0, const std::vector<Vec3>& x_t1) {
    return detection.update(kept_.broad_phase, kept_.finder, x_t0, x_t1);
  }

  /// Finds the candidate pairs and near pairs of the `wanted` pairs of surfaces by a new search.
  void find(const std::vector<SurfacePair>& wanted, const std::vector<Vec3>& x_t0, const std::vector<Vec3>& x_t1,
            CandidatePairs& candidates, std::vector<Proximity>& out) {
    candidates.clear();
    std::vector<Surface> with_themselves;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) fresh_.broad_phase.refit(s, {x_t0, x_t1}, kWidestReach / 2);
    for (const auto& [a, b] : wanted) {
      if (a == b) {
        fresh_.broad_phase.self_pairs(a, candidates);
        with_themselves.push_back(surfaces_[a]);
      } else {
        fresh_.broad_phase.pairs(a, b, candidates);
      }
    }
    fresh_.finder.find(candidates, with_themselves, x_t0, kWidestReach, out);
  }

  Falling motion_;
  std::vector<Surface> surfaces_ = motion_.scene().surfaces();
  Search kept_ = make_search(), fresh_ = make_search();
};

void expect_all(const CandidatePairs& held, const CandidatePairs& needed) {
  for (const auto list : {&CandidatePairs::apart, &CandidatePairs::one_shared}) {
    const Pairs of_held((held.*list).begin(), (held.*list).end()),
        of_needed((needed.*list).begin(), (needed.*list).end());
    EXPECT_TRUE(std::ranges::includes(of_held, of_needed));
    EXPECT_EQ(of_held.size(), (held.*list).size()) << "a pair is listed twice";
  }
}

TEST_F(CoherentDetectionTest, MissesNothingWithinReachAndKeepsClosestPointsWithinTwiceTheRelativeMotion) {
  CoherentDetection detection = make_detection(kAllPairs);
  int found_anew = 0;
  double largest_error = 0;
  for (int step = 0; step < 45; ++step) {
    SCOPED_TRACE(step);
    const std::vector<Vec3> x_t0 = motion_.at(step), x_t1 = motion_.at(step + 1);
    found_anew += update(detection, x_t0, x_t1);
    const double bound = 2 * detection.largest_motion();
    EXPECT_LE(bound, 2 * kBudget);
    for (const Proximity& p : detection.proximities()) {
      const double exact = std::sqrt(of_features(p, x_t0).distance_sq);
      EXPECT_GE(p.distance, exact * (1 - 1e-12));
      EXPECT_LE(p.distance, exact + bound + 1e-12);
      largest_error = std::max(largest_error, p.distance - exact);
    }
    CandidatePairs needed;
    std::vector<Proximity> fresh;
    find(kAllPairs, x_t0, x_t1, needed, fresh);
    expect_all(detection.candidates(), needed);
    for (const Proximity& p : fresh) {
      const auto stands_for = [&](const Proximity& q) {
        return q.distance <= p.distance + bound + 1e-12 && (place(p, x_t0) - place(q, x_t0)).norm() < 0.25;
      };
      EXPECT_TRUE(std::ranges::any_of(detection.proximities(), stands_for));
    }
  }
  // The first two sheets move together and the third arrives, so steps with and without a new search occur.
  EXPECT_GT(45 * 6 - found_anew, 60);
  EXPECT_GT(found_anew, 20);
  EXPECT_GT(largest_error, 1e-6);
}

TEST_F(CoherentDetectionTest, HoldsForAnySteadyCommonMotionAndNotForARelativeOne) {
  const std::vector<Vec3> x = motion_.at(0);
  const auto moved = [&](const Vec3& of_first_two) {
    std::vector<Vec3> all = x;
    for (std::size_t v = 0; v < 2 * kSheet * kSheet; ++v) all[v] += of_first_two;
    return all;
  };
  CoherentDetection together = make_detection({{0, 0}, {0, 1}}), passing = make_detection({{1, 2}});
  EXPECT_EQ(update(together, x, moved({3, 0, 0})), 2);
  EXPECT_EQ(update(passing, x, moved({3, 0, 0})), 1);
  EXPECT_EQ(update(together, moved({3, 0, 0}), moved({6, 0, 0})), 0);
  EXPECT_EQ(update(passing, moved({3, 0, 0}), moved({6, 0, 0})), 1);
}

// The near pairs found for the predicted end stay valid for the solved end if this end is within the velocity cones.
// Otherwise, they are searched again.
TEST_F(CoherentDetectionTest, UpdatedWithinAStepHoldsAllCandidatesOfTheMotionThatCameOut) {
  CoherentDetection detection = make_detection(kAllPairs);
  const std::vector<Vec3> x_t0 = motion_.at(30);
  EXPECT_EQ(update(detection, x_t0, motion_.at(31)), 6);
  std::vector<Vec3> x_t1 = motion_.at(31);
  for (Vec3& p : x_t1) p[2] += 0.0005;
  EXPECT_EQ(update(detection, x_t0, x_t1), 0);
  // One vertex of the second sheet ends between the layers of the first.
  x_t1[kSheet * kSheet + kSheet * kSheet / 2][2] -= 0.06;
  EXPECT_GT(update(detection, x_t0, x_t1), 0);
  CandidatePairs needed;
  std::vector<Proximity> fresh;
  find(kAllPairs, x_t0, x_t1, needed, fresh);
  expect_all(detection.candidates(), needed);
}

TEST_F(CoherentDetectionTest, LooksAtWantedPairsOfSurfacesOnly) {
  const std::vector<Vec3> x_t0 = motion_.at(26), x_t1 = motion_.at(27);
  for (const auto& wanted : std::vector<std::vector<SurfacePair>>{{{0, 0}}, {{0, 1}, {1, 2}}, {{1, 2}}}) {
    CoherentDetection detection = make_detection(wanted);
    EXPECT_EQ(update(detection, x_t0, x_t1), static_cast<int>(wanted.size()));
    CandidatePairs needed;
    std::vector<Proximity> fresh;
    find(wanted, x_t0, x_t1, needed, fresh);
    expect_all(detection.candidates(), needed);
    ASSERT_FALSE(fresh.empty());
    // After its first update, the detection has the same near pairs as a new search.
    const auto vertices = [](std::span<const Proximity> list) {
      std::multiset<std::array<Index, 4>> all;
      for (const Proximity& p : list) all.insert(p.vertices);
      return all;
    };
    EXPECT_EQ(vertices(detection.proximities()), vertices(fresh));
  }
}

// Two triangles with a common edge, folded shut. Candidate pairs do not contain such pairs.
TEST(CoherentDetectionOfAFold, LooksUpTrianglesWithACommonEdgeOfWhatMayMeetItself) {
  const TestMesh fold{{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.5, 0.01}}, {{0, 1, 2}, {1, 0, 3}}};
  const Surface surface = fold.surface();
  BroadPhase broad_phase(std::span(&surface, 1), fold.x);
  ProximityFinder finder(fold.triangles, 4);
  CoherentDetection with(std::span(&surface, 1), {{0, 0}}, fold.x,
                         {.detection_distance = kWidestReach, .budget = kBudget}),
      without(std::span(&surface, 1), {}, fold.x, {.detection_distance = kWidestReach, .budget = kBudget});
  with.update(broad_phase, finder, fold.x, fold.x);
  without.update(broad_phase, finder, fold.x, fold.x);
  ASSERT_EQ(with.proximities().size(), 1U);
  EXPECT_NEAR(with.proximities()[0].distance, 0.01, 1e-15);
  EXPECT_TRUE(without.proximities().empty());
}

TEST_F(CoherentDetectionTest, ForgetsWhatWasBefore) {
  CoherentDetection first = make_detection(kAllPairs), second = make_detection(kAllPairs);
  for (int step = 20; step < 32; ++step) update(first, motion_.at(step), motion_.at(step + 1));
  first.forget();
  EXPECT_EQ(update(first, motion_.at(32), motion_.at(33)), 6);
  update(second, motion_.at(32), motion_.at(33));
  EXPECT_TRUE(std::ranges::equal(first.candidates().apart.view(), second.candidates().apart.view()));
  const auto same = [](const Proximity& p, const Proximity& q) {
    return p.vertices == q.vertices && p.distance == q.distance && p.normal == q.normal;
  };
  EXPECT_TRUE(std::ranges::equal(first.proximities(), second.proximities(), same));
}

}  // namespace
}  // namespace weft::collision
