// Kept detection results against brute force and against fresh searches, step by step.
#include "collision/proximity/coherence.hpp"

#include <gtest/gtest.h>

#include <set>

#include "collision/hierarchy/broad_phase.hpp"
#include "collision/hierarchy/test_motions.hpp"
#include "collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

using testing::folded_sheet;
using testing::MovingScene;
using testing::TestMesh;
using Pairs = std::set<TrianglePair>;

constexpr double kReach = 0.02, kBudget = 0.01;
constexpr int kSheet = 15;

/// A folded sheet and one above it fall fast together and flutter a little; a third comes up from below.
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
  const auto at = [&](std::size_t i) -> const Vec3& { return x[static_cast<std::size_t>(p.vertices[i])]; };
  return p.kind == ProximityKind::vertex_face ? closest_vertex_face(at(0), at(1), at(2), at(3))
                                              : closest_edge_edge(at(0), at(1), at(2), at(3));
}

/// The point of side a.
Vec3 place(const Proximity& p, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    if (p.weights[i] > 0) sum += p.weights[i] * x[static_cast<std::size_t>(p.vertices[i])];
  return sum;
}

class CoherentDetectionTest : public ::testing::Test {
 protected:
  CoherentDetectionTest()
      : surfaces_(motion_.scene().surfaces()),
        broad_phase_(surfaces_, motion_.at(0)),
        finder_(motion_.scene().triangles, static_cast<Index>(motion_.at(0).size())),
        kept_(surfaces_, motion_.at(0), kReach, kBudget) {}

  void find(std::size_t a, std::size_t b, double reach, CandidatePairs& candidates, std::vector<Proximity>& out) {
    for (const std::size_t s : {a, b}) broad_phase_.refit(s, x_t0_, x_t1_, reach / 2);
    candidates.clear();
    if (a == b)
      broad_phase_.self_pairs(a, candidates);
    else
      broad_phase_.pairs(a, b, candidates);
    finder_.find(candidates, a == b ? std::span(surfaces_).subspan(a, 1) : std::span<const Surface>(), x_t0_, reach,
                 out);
  }

  Falling motion_;
  std::vector<Surface> surfaces_;
  BroadPhase broad_phase_;
  ProximityFinder finder_;
  CoherentDetection kept_;
  std::vector<Vec3> x_t0_, x_t1_;
};

TEST_F(CoherentDetectionTest, MissesNothingWithinReachAndKeepsClosestPointsWithinTwiceTheRelativeMotion) {
  int reused = 0, found_anew = 0;
  double largest_error = 0, largest_motion = 0;
  for (int step = 0; step < 45; ++step) {
    x_t0_ = motion_.at(step);
    x_t1_ = motion_.at(step + 1);
    kept_.advance(x_t0_, x_t1_);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b) {
        CandidatePairs candidates;
        std::vector<Proximity> fresh, listed;
        if (kept_.holds(a, b)) {
          ++reused;
        } else {
          ++found_anew;
          find(a, b, kReach + kBudget, candidates, fresh);
          kept_.keep(a, b, candidates, fresh);
        }
        kept_.proximities(a, b, x_t0_, listed);
        const double bound = 2 * kept_.motion_since(a, b);
        largest_motion = std::max(largest_motion, bound);
        for (const Proximity& p : listed) {
          const double exact = std::sqrt(of_features(p, x_t0_).distance_sq);
          EXPECT_GE(p.distance, exact * (1 - 1e-12));
          EXPECT_LE(p.distance, exact + bound + 1e-12);
          largest_error = std::max(largest_error, p.distance - exact);
        }

        find(a, b, kReach, candidates, fresh);
        const auto& held = kept_.candidates(a, b);
        for (const auto list : {&CandidatePairs::apart, &CandidatePairs::one_shared}) {
          const Pairs all((held.*list).begin(), (held.*list).end()),
              needed((candidates.*list).begin(), (candidates.*list).end());
          EXPECT_TRUE(std::ranges::includes(all, needed)) << "step " << step << ", surfaces " << a << " " << b;
        }
        for (const Proximity& p : fresh) {
          const auto stands_for = [&](const Proximity& q) {
            return q.distance <= p.distance + bound + 1e-12 && (place(p, x_t0_) - place(q, x_t0_)).norm() < 0.25;
          };
          EXPECT_TRUE(std::ranges::any_of(listed, stands_for)) << "step " << step << ", surfaces " << a << " " << b;
        }
      }
  }
  // The first two move together, the third arrives: both kinds of steps are there, and the bound is used, not idle.
  EXPECT_GT(reused, 60);
  EXPECT_GT(found_anew, 20);
  EXPECT_GT(largest_error, 1e-6);
  EXPECT_LE(largest_motion, 2 * kBudget);
}

TEST_F(CoherentDetectionTest, HoldsForAnySteadyCommonMotionAndNotForARelativeOne) {
  x_t0_ = motion_.at(0);
  const auto moved = [&](const Vec3& of_first_two) {
    std::vector<Vec3> x = x_t0_;
    for (std::size_t v = 0; v < 2 * kSheet * kSheet; ++v) x[v] += of_first_two;
    return x;
  };
  x_t1_ = moved({3, 0, 0});
  kept_.advance(x_t0_, x_t1_);
  EXPECT_FALSE(kept_.holds(0, 1));
  kept_.keep(0, 1, {}, {});
  kept_.keep(1, 2, {}, {});
  kept_.advance(x_t1_, moved({6, 0, 0}));
  EXPECT_TRUE(kept_.holds(0, 1));
  EXPECT_FALSE(kept_.holds(1, 2)) << "they pass each other";
}

}  // namespace
}  // namespace weft::collision
