// Compares the pairs that normal cones skip with brute force: none is within the detection distance during the step.
#include "physics/collision/variants/normal_cones.hpp"

#include <gtest/gtest.h>

#include <set>

#include "collision/hierarchy/feature_distance.hpp"
#include "collision/hierarchy/test_motions.hpp"
#include "physics/mesh/shapes.hpp"

namespace weft::collision {
namespace {

using testing::feature_distance;
using testing::folded_sheet;
using testing::FoldingSlidingFlying;
using testing::random_vec;
using testing::TestMesh;
using Pairs = std::set<TrianglePair>;

/// Minimum feature distance during the linear motion, sampled at nine times [m].
double least_distance(const Triangle& a, const Triangle& b, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  std::vector<Vec3> x(x_t0.size(), Vec3::Zero());
  double minimum = 1e300;
  for (int i = 0; i <= 8; ++i) {
    for (const Triangle& t : {a, b})
      for (const Index v : t) {
        const auto n = static_cast<std::size_t>(v);
        x[n] = x_t0[n] + i / 8.0 * (x_t1[n] - x_t0[n]);
      }
    minimum = std::min(minimum, feature_distance(a, b, x));
  }
  return minimum;
}

struct SkippedPairs {
  std::size_t pairs = 0;         ///< pairs listed only without cones
  std::size_t within_reach = 0;  ///< how many of these are within the detection distance
};

/// Pairs that the cones skip in one step.
template <int K>
SkippedPairs find_skipped_pairs(const Surface& surface, std::span<const Vec3> x_t0, std::span<const Vec3> x_t1,
                                double reach, const TreeShape& shape) {
  Tree<K> tree(surface, x_t0, shape);
  tree.refit({x_t0, x_t1}, reach / 2);
  NormalCones<K> cones(tree);
  cones.update(tree, x_t0, x_t1, reach);
  CandidatePairs all, with_cones;
  self_pairs(tree, all);
  Traversal how;
  how.regions = &cones.regions();
  self_pairs(tree, with_cones, how);

  SkippedPairs result;
  for (const auto list : {&CandidatePairs::apart, &CandidatePairs::one_shared}) {
    const Pairs expected((all.*list).begin(), (all.*list).end());
    const Pairs found((with_cones.*list).begin(), (with_cones.*list).end());
    EXPECT_TRUE(std::ranges::includes(expected, found));
    for (const TrianglePair& pair : expected) {
      if (found.contains(pair)) continue;
      ++result.pairs;
      const auto triangle = [&](Index t) { return surface.triangles[t - surface.first_triangle]; };
      if (least_distance(triangle(pair.a), triangle(pair.b), x_t0, x_t1) < reach) ++result.within_reach;
    }
  }
  return result;
}

SkippedPairs find_skipped_pairs(const TestMesh& mesh, double reach) {
  return find_skipped_pairs<6>(mesh.surface(), mesh.x, mesh.x, reach, {4, 4});
}

/// A strip of 4 × n vertices that winds around the z axis `turns` times, and rises by `pitch` in each turn. Seen from
/// above, it covers itself, although all its normals are nearly vertical.
TestMesh spiral_stair(int n, double turns, double pitch) {
  TestMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 4; ++j) {
      const double angle = 2 * M_PI * turns * i / (n - 1), radius = 1 + 0.1 * j;
      mesh.x.emplace_back(radius * std::cos(angle), radius * std::sin(angle), pitch * turns * i / (n - 1));
    }
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j < 3; ++j) {
      const Index a = 4 * i + j;
      mesh.triangles.push_back({a, a + 1, a + 5});
      mesh.triangles.push_back({a, a + 5, a + 4});
    }
  return mesh;
}

/// A flat sheet of n × n vertices over the unit square. A slit along x = ½ cuts the first `rows` rows of quads; its
/// sides are `gap` apart.
TestMesh slit_sheet(int n, int rows, double gap) {
  TestMesh mesh = folded_sheet(n, 1, 0);
  for (Vec3& p : mesh.x) p[2] = 0;
  const Index middle = n / 2;
  // Duplicates the vertices of the slit; triangles to its right get the copies.
  for (Index j = 0; j < rows; ++j) {
    const Index left = middle + n * j, right = static_cast<Index>(mesh.x.size());
    mesh.x.push_back(mesh.x[left] + Vec3{gap / 2, 0, 0});
    for (Triangle& t : mesh.triangles) {
      const bool on_right = std::ranges::any_of(t, [&](Index v) { return v < n * n && v % n > middle; });
      if (on_right) std::ranges::replace(t, left, right);
    }
    mesh.x[left] -= Vec3{gap / 2, 0, 0};
  }
  return mesh;
}

TEST(NormalCones, LeaveOutNothingWithinReachOfFoldingSheetsAtAnyStepTreeAndReach) {
  const FoldingSlidingFlying motion(24);
  const std::vector<Surface> surfaces = motion.scene().surfaces();
  std::size_t pairs = 0;
  for (int step = 0; step < 30; step += 3) {
    const std::vector<Vec3> x_t0 = motion.at(step), x_t1 = motion.at(step + 1);
    for (const double reach : {0.005, 0.02, 0.04}) {  // the altitudes of the triangles are 0.031 m
      const std::array<SkippedPairs, 3> all{
          find_skipped_pairs<6>(surfaces[0], x_t0, x_t1, reach, {8, 8}),
          find_skipped_pairs<18>(surfaces[1], x_t0, x_t1, reach, {2, 3}),
          find_skipped_pairs<26>(surfaces[2], x_t0, x_t1, reach, {4, 1}),
      };
      for (const SkippedPairs& one : all) {
        EXPECT_EQ(one.within_reach, 0U) << "step " << step << " reach " << reach;
        pairs += one.pairs;
      }
    }
  }
  EXPECT_GT(pairs, 1000U) << "nothing was left out";
}

TEST(NormalCones, LeaveOutNothingWithinReachOfASheetThatCrumplesAtRandom) {
  const TestMesh mesh = folded_sheet(16, 1, 0.01);
  std::mt19937 generator(8);
  std::size_t pairs = 0;
  for (const double amount : {0.002, 0.005, 0.01, 0.02, 0.04}) {
    std::vector<Vec3> x_t0 = mesh.x, x_t1 = mesh.x;
    for (Vec3& p : x_t0) p += amount * random_vec(generator);
    for (Vec3& p : x_t1) p += amount * random_vec(generator);
    for (const double reach : {0.0, 0.01, 0.03}) {
      const SkippedPairs result = find_skipped_pairs<6>(mesh.surface(), x_t0, x_t1, reach, {2, 2});
      EXPECT_EQ(result.within_reach, 0U) << amount << " " << reach;
      pairs += result.pairs;
    }
  }
  EXPECT_GT(pairs, 100U);
}

// All normals are nearly vertical; only the contour test detects that the strip covers itself.
TEST(NormalCones, MissNothingThatLiesOverItselfOnASpiralStair) {
  const SkippedPairs result = find_skipped_pairs(spiral_stair(120, 3, 0.01), 0.02);
  EXPECT_EQ(result.within_reach, 0U);
}

// All normals are equal; only the border test detects the slit.
TEST(NormalCones, MissNothingThatLiesAcrossASlit) {
  const SkippedPairs result = find_skipped_pairs(slit_sheet(17, 8, 0.004), 0.01);
  EXPECT_EQ(result.within_reach, 0U);
  EXPECT_GT(result.pairs, 100U);
}

TEST(NormalCones, SeeWhatHappensOnlyDuringTheStep) {
  // The sheet makes half a turn in its plane, on straight lines. Normals are equal at start and end, but all points
  // coincide halfway.
  TestMesh mesh = folded_sheet(12, 1, 0);
  for (Vec3& p : mesh.x) p[2] = 0;
  std::vector<Vec3> x_t1;
  for (const Vec3& p : mesh.x) x_t1.emplace_back(1 - p[0], 1 - p[1], 0);
  EXPECT_GT((find_skipped_pairs<6>(mesh.surface(), mesh.x, mesh.x, 0.01, {4, 4}).pairs), 0U);
  EXPECT_EQ((find_skipped_pairs<6>(mesh.surface(), mesh.x, x_t1, 0.01, {4, 4}).pairs), 0U);
}

TEST(NormalCones, LeaveNothingOutOnceTheReachExceedsTheAltitudes) {
  TestMesh mesh = folded_sheet(17, 1, 0);
  for (Vec3& p : mesh.x) p[2] = 0;
  const double altitude = std::sqrt(0.5) / 16;
  EXPECT_GT(find_skipped_pairs(mesh, 0.99 * altitude).pairs, 100U);
  EXPECT_EQ(find_skipped_pairs(mesh, 1.01 * altitude).pairs, 0U);
}

TEST(NormalCones, MissNothingAcrossANotchInAStarShapedBorder) {
  // A notch from the lower border towards the centre. Seen from the centre, the border, with the notch, runs around in
  // one direction.
  TestMesh sheet = slit_sheet(9, 3, 0.002);
  for (Vec3& p : sheet.x)
    if (p[1] < 0.375 && std::abs(p[0] - 0.5) < 0.01) p[0] += (p[0] < 0.5 ? -0.1 : 0.1) * (0.375 - p[1]);
  for (int leaf : {1, 8}) {
    // At y = 0.25 m, the notch is 0.027 m wide; the triangles beside it have altitudes of at least 0.07 m.
    const SkippedPairs result = find_skipped_pairs<6>(sheet.surface(), sheet.x, sheet.x, 0.04, {2, leaf});
    EXPECT_EQ(result.within_reach, 0U);
  }
}

// The normals of half a ball with the triangles around it fit into no cone with a half-angle below 90 degrees; those of
// small patches do.
TEST(NormalCones, EndAtARightAngle) {
  const mesh::Mesh ball = mesh::make_sphere(0.5, 24);
  const TestMesh mesh{ball.positions, {ball.topology.triangles.begin(), ball.topology.triangles.end()}};
  const Tree<6> tree(mesh.surface(), mesh.x, {2, 2});
  NormalCones<6> cones(tree);
  cones.update(tree, mesh.x, mesh.x, 1e-4);
  const Regions& regions = cones.regions();
  for (const auto half : std::span(tree.nodes()[0].child).first(2)) EXPECT_FALSE(regions.has_nothing_near(half));
  EXPECT_GT(std::ranges::count(regions.node, 1) + std::ranges::count(regions.leaf, 1), 10);
}

TEST(StarShaped, HoldsForAChainThatRunsAroundItsCentreOnceAndAlwaysForward) {
  const auto chain = [](const std::vector<double>& angles, const std::vector<double>& radii) {
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < angles.size(); ++i)
      x.emplace_back(radii[i] * std::cos(angles[i]), radii[i] * std::sin(angles[i]), 0.3 * static_cast<double>(i % 2));
    return x;
  };
  std::vector<double> once, twice, radii;
  for (int i = 0; i < 12; ++i) {
    once.push_back(2 * M_PI * i / 12);
    twice.push_back(4 * M_PI * i / 12);
    radii.push_back(i % 2 == 0 ? 1 : 0.6);
  }
  std::vector<std::array<Index, 2>> edges;
  for (Index i = 0; i < 12; ++i) edges.push_back({i, (i + 1) % 12});
  const std::vector<Vec3> star = chain(once, radii);
  EXPECT_TRUE(is_star_shaped(edges, Vec3::UnitZ(), star, star));
  EXPECT_FALSE(is_star_shaped(edges, -Vec3::UnitZ(), star, star)) << "seen from behind it runs backward";
  const std::vector<Vec3> wound = chain(twice, radii);
  EXPECT_FALSE(is_star_shaped(edges, Vec3::UnitZ(), wound, wound)) << "runs around twice";
  std::vector<double> hooked = once;
  std::swap(hooked[4], hooked[5]);
  const std::vector<Vec3> hook = chain(hooked, radii);
  EXPECT_FALSE(is_star_shaped(edges, Vec3::UnitZ(), hook, hook));
  // During half a turn about the axis, on straight lines, all points are on the axis at half of the step.
  std::vector<double> turned;
  for (const double angle : once) turned.push_back(angle + M_PI);
  EXPECT_FALSE(is_star_shaped(edges, Vec3::UnitZ(), star, chain(turned, radii)));
}

}  // namespace
}  // namespace weft::collision
