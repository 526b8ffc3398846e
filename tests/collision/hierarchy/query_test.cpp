// Compares queries of a single hierarchy with brute force over all triangles.
#include "physics/collision/hierarchy/query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "collision/hierarchy/test_motions.hpp"
#include "physics/collision/proximity/closest_points.hpp"

namespace weft::collision {
namespace {

using testing::FoldingSlidingFlying;
using testing::kMargin;
using testing::random_vec;

constexpr double kNone = std::numeric_limits<double>::infinity();  // distance of an excluded triangle

double distance_sq(const Vec3& p, const Triangle& t, std::span<const Vec3> x) {
  return closest_vertex_face(p, x[t[0]], x[t[1]], x[t[2]]).distance_sq;
}

/// Maximum, over the axes, of the gap between two boxes [m]: that of a triangle's corners at all `times`, and that from
/// `low` to `high`.
double box_gap(std::initializer_list<std::span<const Vec3>> times, const Triangle& t, const Vec3& low,
               const Vec3& high) {
  Vec3 corner_min = Vec3::Constant(kNone), corner_max = Vec3::Constant(-kNone);
  for (const std::span<const Vec3> x : times)
    for (const Index v : t) corner_min = corner_min.cwiseMin(x[v]), corner_max = corner_max.cwiseMax(x[v]);
  return std::max((corner_min - high).maxCoeff(), (low - corner_max).maxCoeff());
}

template <class K>
class HierarchyQuery : public ::testing::Test {};
using AllK =
    ::testing::Types<std::integral_constant<int, 6>, std::integral_constant<int, 18>, std::integral_constant<int, 26>>;
TYPED_TEST_SUITE(HierarchyQuery, AllK);

/// A tree, the motion from x_t0 to x_t1 to which it was fitted, and positions x within the margin of this motion.
template <int K>
struct Fit {
  const Tree<K>& tree;
  std::span<const Vec3> x_t0, x_t1, x;
};

/// Calls check(fit) for each moving surface, several tree shapes, and both kinds of refit.
template <int K, class Check>
void for_all_fits(const Check& check) {
  const FoldingSlidingFlying motion(12);
  std::mt19937 generator(3);
  for (const Surface& surface : motion.scene().surfaces())
    for (const TreeShape& shape : {TreeShape{8, 8}, TreeShape{2, 1}, TreeShape{4, 3}}) {
      Tree<K> tree(surface, motion.at(0), shape);
      for (int step = 0; step < 24; step += 4) {
        const std::vector<Vec3> x_t0 = motion.at(step), x_t1 = motion.at(step + 2);
        if (step % 8 == 0)
          tree.refit({x_t0, x_t1}, kMargin);
        else
          tree.refit_lazily({x_t0, x_t1}, kMargin);
        std::vector<Vec3> x = motion.at(step);
        for (std::size_t v = 0; v < x.size(); ++v)
          x[v] += step / 24.0 * (x_t1[v] - x_t0[v]) + 0.99 * kMargin * random_vec(generator).stableNormalized();
        check(Fit<K>{tree, x_t0, x_t1, x});
      }
    }
}

TYPED_TEST(HierarchyQuery, ForTheNearestTrianglesFindsThemAndAllTiesOfThoseThatCount) {
  std::mt19937 generator(7);
  std::size_t measured = 0, all = 0, ties = 0;
  for_all_fits<TypeParam::value>([&](const auto& fit) {
    const Surface& surface = fit.tree.surface();
    for (int i = 0; i < 40; ++i) {
      // Half of the points are random. The others are vertices, whose triangles are all at distance 0.
      const Index vertex = surface.first_vertex + static_cast<Index>(generator() % 1000) % surface.vertex_count;
      const Vec3 p = i % 2 == 0 ? random_vec(generator) : fit.x[vertex];
      // In every third query, every third triangle is excluded.
      const auto measure = [&](Index t) {
        return i % 3 == 0 && t % 3 == 0 ? kNone : distance_sq(p, surface.triangles[t - surface.first_triangle], fit.x);
      };
      double minimum = kNone;
      std::vector<Index> expected, found;
      const auto count = static_cast<Index>(surface.triangles.size());
      for (Index t = surface.first_triangle; t < surface.first_triangle + count; ++t)
        minimum = std::min(minimum, measure(t));
      for (Index t = surface.first_triangle; t < surface.first_triangle + count; ++t)
        if (measure(t) <= (1 + kNearestTolerance) * minimum) expected.push_back(t);
      nearest_triangles(
          fit.tree, p,
          [&](Index t) {
            ++measured;
            return measure(t);
          },
          found);
      ASSERT_EQ(found, expected) << p.transpose();
      all += surface.triangles.size();
      ties += expected.size() > 1;
    }
  });
  EXPECT_GT(ties, 100U);
  EXPECT_LT(4 * measured, all) << "most triangles are ruled out by their bounds";
}

TYPED_TEST(HierarchyQuery, ForTheNearestOfTrianglesNoneOfWhichCountFindsNone) {
  const testing::TestMesh mesh = testing::folded_sheet(9, 1, 0);
  const Tree<TypeParam::value> tree(mesh.surface(), mesh.x), empty(Surface{}, {});
  std::vector<Index> found{1};
  nearest_triangles(
      tree, Vec3::Zero(), [](Index) { return kNone; }, found);
  EXPECT_TRUE(found.empty());
  found = {1};
  nearest_triangles(
      empty, Vec3::Zero(), [](Index) { return 0.0; }, found);
  EXPECT_TRUE(found.empty());
}

TYPED_TEST(HierarchyQuery, ForABoxFindsAllThatMeetItAndNoneBeyondItsBounds) {
  std::mt19937 generator(9);
  std::size_t met = 0;
  for_all_fits<TypeParam::value>([&](const auto& fit) {
    const Surface& surface = fit.tree.surface();
    for (int i = 0; i < 20; ++i) {
      const Vec3 centre = random_vec(generator), half = 0.3 * random_vec(generator).cwiseAbs();
      const Vec3 low = centre - half, high = centre + half;
      std::vector<Index> found;
      triangles_in_box(fit.tree, low, high, found);
      EXPECT_TRUE(std::ranges::is_sorted(found));
      EXPECT_EQ(std::ranges::adjacent_find(found), found.end()) << "a triangle is listed twice";
      for (std::size_t n = 0; n < surface.triangles.size(); ++n) {
        const Triangle& t = surface.triangles[n];
        const bool listed = std::ranges::binary_search(found, surface.first_triangle + static_cast<Index>(n));
        const bool meets = box_gap({fit.x}, t, low, high) <= 0;
        EXPECT_TRUE(listed || !meets);
        // Bounds of a lazy refit may exceed the margin by an eighth; 0.001 is for rounding.
        EXPECT_TRUE(!listed || box_gap({fit.x_t0, fit.x_t1}, t, low, high) <= 1.126 * kMargin);
        met += meets;
      }
    }
  });
  EXPECT_GT(met, 500U);
}

}  // namespace
}  // namespace weft::collision
