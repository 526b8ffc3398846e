// Compares the candidate pairs of the hierarchy with brute force over all pairs, as sets.
#include <gtest/gtest.h>

#include <set>

#include "collision/hierarchy/test_meshes.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "physics/collision/hierarchy/split.hpp"
#include "physics/collision/hierarchy/traversal.hpp"

namespace weft::collision {
namespace {

using testing::folded_sheet;
using testing::random_vec;
using testing::TestMesh;
using testing::triangle_soup;
using Pairs = std::set<TrianglePair>;

/// Number of directions of the k-DOPs, and shape of the tree.
template <int TestK, int children, int leaf>
struct Setup {
  static constexpr int K = TestK;
  static constexpr TreeShape kShape{children, leaf};
  using TreeType = Tree<K>;
};

template <class S>
class HierarchyPairs : public ::testing::Test {};

using Setups = ::testing::Types<Setup<6, 2, 1>, Setup<6, 4, 3>, Setup<6, 8, 8>, Setup<6, 8, 1>, Setup<18, 2, 4>,
                                Setup<18, 4, 8>, Setup<18, 8, 2>, Setup<26, 2, 5>, Setup<26, 4, 4>, Setup<26, 8, 8>>;
TYPED_TEST_SUITE(HierarchyPairs, Setups);

/// Bounds of triangles in double precision: intervals along each direction, at the start and at the end of the step.
template <int K>
class BruteForce {
 public:
  BruteForce(const TestMesh& mesh, std::span<const Vec3> x_t1, double margin)
      : mesh_(mesh), x_t1_(x_t1), margin_(margin) {}

  /// Gap between the bounds of two triangles [m]: the maximum, over all directions, of the gap that exists both at the
  /// start and at the end, with the margins subtracted. The bounds overlap if it is not positive.
  double gap(const Triangle& a, const Triangle& b) const {
    double max_gap = -1e300;
    for (int d = 0; d < K; d += 2) {
      const auto& dir = kDirections<K>;
      const auto row = static_cast<std::size_t>(d);
      const Vec3 axis = Vec3{dir.x[row], dir.y[row], dir.z[row]}.normalized();
      double above = 1e300, below = 1e300;
      for (const bool at_end : {false, true}) {
        const auto [a_low, a_high] = interval(a, axis, at_end);
        const auto [b_low, b_high] = interval(b, axis, at_end);
        above = std::min(above, a_low - b_high);
        below = std::min(below, b_low - a_high);
      }
      max_gap = std::max({max_gap, above, below});
    }
    return max_gap;
  }

 private:
  std::pair<double, double> interval(const Triangle& t, const Vec3& axis, bool at_end) const {
    double low = 1e300, high = -1e300;
    for (const Index v : t) {
      const double along = axis.dot(at_end ? x_t1_[v] : mesh_.x[v]);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    return {low - margin_, high + margin_};
  }

  const TestMesh& mesh_;
  std::span<const Vec3> x_t1_;
  double margin_;
};

/// The list as a set; fails if a pair occurs twice.
Pairs as_set(const PairList& list) {
  const Pairs set(list.begin(), list.end());
  EXPECT_EQ(set.size(), list.size()) << "a pair is listed twice";
  return set;
}

/// Checks that `found` has all `required` pairs and only `allowed` ones. Bounds are rounded outward to float, which may
/// add pairs whose gap is at most a few 1e-7 of the coordinates.
void expect_between(const Pairs& required, const Pairs& found, const Pairs& allowed) {
  EXPECT_TRUE(std::includes(found.begin(), found.end(), required.begin(), required.end()));
  EXPECT_TRUE(std::includes(allowed.begin(), allowed.end(), found.begin(), found.end()));
}

template <class S>
void expect_self_pairs(const TestMesh& mesh, const typename S::TreeType& tree, std::span<const Vec3> x_t1,
                       double margin) {
  constexpr double kRounding = 1e-6;  // [m]; four rounding errors of 2^-23 of coordinates up to 2 m
  const BruteForce<S::K> brute(mesh, x_t1, margin);
  std::array<Pairs, 2> required, allowed;
  for (std::size_t a = 0; a < mesh.triangles.size(); ++a) {
    for (std::size_t b = a + 1; b < mesh.triangles.size(); ++b) {
      const std::size_t shared = testing::shared_count(mesh.triangles[a], mesh.triangles[b]);
      if (shared > 1) continue;
      const double gap = brute.gap(mesh.triangles[a], mesh.triangles[b]);
      const TrianglePair pair{static_cast<Index>(a), static_cast<Index>(b)};
      if (gap <= 0) required[shared].insert(pair);
      if (gap <= kRounding) allowed[shared].insert(pair);
    }
  }
  CandidatePairs found;
  self_pairs(tree, found);
  expect_between(required[0], as_set(found.apart), allowed[0]);
  expect_between(required[1], as_set(found.one_shared), allowed[1]);
}

TYPED_TEST(HierarchyPairs, OfASoupWithEqualAndDegenerateTrianglesEqualBruteForce) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const TestMesh mesh = triangle_soup(seed, 40, 300, seed == 1 ? 0.5 : 0.1);
    const typename TypeParam::TreeType tree(mesh.surface(), mesh.x, TypeParam::kShape);
    expect_self_pairs<TypeParam>(mesh, tree, mesh.x, 0);
  }
}

TYPED_TEST(HierarchyPairs, OfAMovingMeshEqualBruteForceAfterEachRefit) {
  const TestMesh mesh = folded_sheet(11, 3, 0.02);
  typename TypeParam::TreeType tree(mesh.surface(), mesh.x, TypeParam::kShape);
  std::mt19937 generator(5);
  for (const double motion : {0.0, 0.03, 0.5}) {
    std::vector<Vec3> x_t1 = mesh.x;
    for (Vec3& p : x_t1) p += motion * random_vec(generator);
    for (const double margin : {0.0, 0.01}) {
      tree.refit({mesh.x, x_t1}, margin);
      expect_self_pairs<TypeParam>(mesh, tree, x_t1, margin);
    }
  }
}

TYPED_TEST(HierarchyPairs, CoverTouchingTrianglesAtLargeCoordinates) {
  // Each triangle touches the next in one point, 1 km from the origin, where float has a resolution of 6e-5 m.
  TestMesh mesh;
  for (int i = 0; i < 40; ++i) {
    const Vec3 corner = Vec3{1000, -900, 0} + 0.1 * i * Vec3{1, 1, 1} / 3;
    for (const Vec3& p : {corner, Vec3(corner + Vec3{0, 0, 0.01}), Vec3(corner + 0.1 * Vec3{1, 1, 1} / 3)})
      mesh.x.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (int i = 0; i + 1 < 40; ++i) mesh.x[3 * i + 2] = mesh.x[3 * i + 3];
  const typename TypeParam::TreeType tree(mesh.surface(), mesh.x, TypeParam::kShape);
  CandidatePairs found;
  self_pairs(tree, found);
  const Pairs apart = as_set(found.apart);
  for (Index i = 0; i + 1 < 40; ++i) EXPECT_TRUE(apart.contains({i, i + 1})) << i;
}

TYPED_TEST(HierarchyPairs, OfTrianglesInOnePlaceAreAllPairs) {
  TestMesh mesh;
  for (Index i = 0; i < 50; ++i) {
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) mesh.x.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const typename TypeParam::TreeType tree(mesh.surface(), mesh.x, TypeParam::kShape);
  CandidatePairs found;
  self_pairs(tree, found);
  EXPECT_EQ(as_set(found.apart).size(), 50U * 49 / 2);
}

TYPED_TEST(HierarchyPairs, ComeInTheSameOrderEveryTime) {
  const TestMesh mesh = folded_sheet(20, 4, 0.01);
  typename TypeParam::TreeType tree(mesh.surface(), mesh.x, TypeParam::kShape);
  const typename TypeParam::TreeType again(mesh.surface(), mesh.x, TypeParam::kShape);
  CandidatePairs first, second;
  self_pairs(tree, first);
  self_pairs(again, second);
  EXPECT_TRUE(std::ranges::equal(first.apart.view(), second.apart.view()));
  tree.refit({mesh.x, mesh.x}, 0.05);
  tree.refit({mesh.x, mesh.x}, 0);
  second.clear();
  self_pairs(tree, second);
  EXPECT_TRUE(std::ranges::equal(first.one_shared.view(), second.one_shared.view()));
}

TEST(Hierarchy, HoldsEveryTriangleOnceInNodesAndLeavesOfItsShapeAndParentsBeforeChildren) {
  const TestMesh mesh = folded_sheet(30, 3, 0.01);
  for (int capacity = 1; capacity <= kLanes; ++capacity) {
    const TreeShape shape{std::max(2, capacity), capacity};
    const Tree<18> tree(mesh.surface(), mesh.x, shape);
    std::multiset<Index> held;
    for (const auto& leaf : tree.leaves()) {
      EXPECT_LE(leaf.count, shape.leaf);
      held.insert(leaf.triangle, leaf.triangle + leaf.count);
    }
    std::multiset<Index> expected;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) expected.insert(static_cast<Index>(t));
    EXPECT_EQ(held, expected);
    for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
      EXPECT_LE(tree.nodes()[n].count, shape.children);
      for (int i = 0; i < tree.nodes()[n].count; ++i)
        EXPECT_TRUE(tree.nodes()[n].child[i] < 0 || tree.nodes()[n].child[i] > static_cast<int>(n));
    }
    EXPECT_EQ(tree.nodes()[0].count, shape.children) << "the root has triangles enough for all";
  }
}

TEST(Hierarchy, ListsPairsInTheSameOrderOnAnyNumberOfThreads) {
  // Three layers, with enough leaves for several threads.
  const TestMesh sheet = folded_sheet(64, 3, 0.01);
  Tree<6> tree(sheet.surface(), sheet.x), other = tree;
  tree.refit({sheet.x, sheet.x}, 0.004);
  const auto listed = [&](int threads) {
    set_thread_count(threads);
    CandidatePairs pairs;
    self_pairs(tree, pairs);
    collision::pairs(tree, other, pairs);
    std::vector<TrianglePair> list(pairs.apart.begin(), pairs.apart.end());
    list.insert(list.end(), pairs.one_shared.begin(), pairs.one_shared.end());
    return list;
  };
  const std::vector<TrianglePair> alone = listed(1);
  EXPECT_GT(alone.size(), 10'000U);
  for (int threads : {2, 4, 8}) EXPECT_TRUE(listed(threads) == alone) << threads;
  set_thread_count(0);
}

TEST(Hierarchy, OfNothingHasNoPairs) {
  const TestMesh mesh = folded_sheet(3, 1, 0);
  const Tree<6> empty(Surface{}, {}), tree(mesh.surface(), mesh.x);
  CandidatePairs found;
  self_pairs(empty, found);
  pairs(empty, tree, found);
  pairs(tree, empty, found);
  EXPECT_TRUE(found.apart.empty());
}

TEST(Hierarchy, RefusesIndicesOutsideTheSurfaceAndShapesWithoutLanes) {
  TestMesh mesh = folded_sheet(3, 1, 0);
  EXPECT_THROW(Tree<6>(mesh.surface(), mesh.x, {8, 9}), Error);
  EXPECT_THROW(Tree<6>(mesh.surface(), mesh.x, {1, 8}), Error);
  mesh.triangles[2][1] = 9;
  EXPECT_THROW(Tree<6>(mesh.surface(), mesh.x), Error);
  mesh.x.pop_back();
  const Surface outside{{}, 0, 0, 9};
  EXPECT_THROW(Tree<6>(outside, mesh.x), Error);
}

TEST(SplitLongestSide, PutsCutTrianglesOnTheSideWithFewerUncutOnes) {
  // Intervals along x. The plane x = 5 has three of them below it and two above it, and cuts the one from 4 to 6.
  const std::array<std::pair<double, double>, 6> spans{{{0, 1}, {4, 6}, {1, 2}, {8, 10}, {2, 3}, {6, 7}}};
  std::vector<KDop<6>> bounds;
  for (const auto& [low, high] : spans) bounds.push_back(swept_point<6>({low, 0, 0}, {high, 1, 1}, 0));
  std::vector<Index> items{0, 1, 2, 3, 4, 5};
  EXPECT_EQ(split_longest_side<6>(items, bounds), 3U);
  EXPECT_EQ(items, (std::vector<Index>{0, 2, 4, 1, 3, 5}));
}

TEST(SplitLongestSide, UsesTheDirectionWhoseFacesAreFurthestApart) {
  // The points lie along the diagonal of x and y, one of the directions of the 18-DOP. Along it, the set is 10.6 m
  // long; along x, 7.5 m.
  std::vector<KDop<18>> bounds;
  for (int i = 0; i < 4; ++i) {
    const Vec3 p{2.5 * i, 2.5 * i, 3.0 * (i % 2)};
    bounds.push_back(swept_point<18>(p, p, 0));
  }
  KDop<18> hull = bounds[0];
  for (const auto& b : bounds) hull.join(b);
  EXPECT_NEAR(hull.side(0), 7.5, 1e-5);
  EXPECT_NEAR(hull.side(3), 7.5 * std::sqrt(2.0), 1e-5);
  std::vector<Index> items{3, 1, 0, 2};
  EXPECT_EQ(split_longest_side<18>(items, bounds), 2U);
  EXPECT_EQ(items, (std::vector<Index>{1, 0, 3, 2}));
}

TEST(SweptPoint, BoundsBothEndsAndTheMarginInEveryDirection) {
  std::mt19937 generator(3);
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::pow(10.0, i % 10 - 6);
    const Vec3 p = scale * random_vec(generator), q = scale * random_vec(generator);
    const double margin = 1e-3 * scale * (i % 3);
    const KDop<26> bound = swept_point<26>(p, q, margin);
    for (std::size_t r = 0; r < 26; ++r) {
      const auto& dir = kDirections<26>;
      const Eigen::Matrix<long double, 3, 1> axis(dir.x[r], dir.y[r], dir.z[r]);
      const long double low =
          std::min(axis.dot(p.cast<long double>()), axis.dot(q.cast<long double>())) - margin * axis.norm();
      EXPECT_LE(static_cast<long double>(bound.row[r]), low);
      EXPECT_GE(static_cast<long double>(bound.row[r]), low - 1e-6L * scale);
    }
  }
}

}  // namespace
}  // namespace weft::collision
