#include "physics/mesh/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/mesh_measures.hpp"

namespace weft::mesh {
namespace {

using Pair = std::array<Index, 2>;
using Pairs = std::vector<Pair>;

// The square 0 1 2 3, split along the diagonal from 0 to 2.
const std::vector<Triangle> kSquare{{0, 1, 2}, {0, 2, 3}};

// A tetrahedron; its triangles are counter-clockwise seen from outside.
const std::vector<Triangle> kFourSides{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

TEST(Edges, AreListedOnceSortedWithTheTrianglesOnBothSides) {
  const EdgeSet set = collect_edges(kSquare);
  Pairs vertices, triangles;
  for (const Edge& edge : set.edges) {
    vertices.push_back(edge.vertices);
    triangles.push_back(edge.triangles);
  }
  EXPECT_EQ(vertices, (Pairs{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}}));
  EXPECT_EQ(triangles, (Pairs{{0, -1}, {0, 1}, {1, -1}, {0, -1}, {1, -1}}));
}

TEST(Edges, OfATriangleFollowItsCorners) {
  const EdgeSet set = collect_edges(kFourSides);
  ASSERT_EQ(set.edges.size(), 6u);
  for (std::size_t t = 0; t < kFourSides.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      Pair expected{kFourSides[t][k], kFourSides[t][(k + 1) % 3]};
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(set.edges[set.of_triangle[t][k]].vertices, expected);
    }
  }
}

TEST(Edges, WithThreeTrianglesKeepTheFirstTwo) {
  const EdgeSet set = collect_edges(std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(set.edges[0].vertices, (Pair{0, 1}));
  EXPECT_EQ(set.edges[0].triangles, (Pair{0, 1}));
}

TEST(Components, AreNumberedInTheOrderOfTheirFirstVertices) {
  const std::vector<Triangle> triangles{{5, 3, 6}, {0, 2, 7}, {3, 6, 8}};
  EXPECT_EQ(components(triangles, 9), (std::vector<Index>{0, 1, 0, 2, 3, 2, 2, 0, 2}));
}

TEST(Inspection, CallsATetrahedronWatertightAndASquareMerelyManifold) {
  EXPECT_TRUE(support::watertight(inspect(kFourSides, 4)));
  const TopologyReport square = inspect(kSquare, 4);
  EXPECT_TRUE(square.manifold());
  EXPECT_FALSE(support::watertight(square));
  EXPECT_EQ(square.border, (Pairs{{0, 1}, {0, 3}, {1, 2}, {2, 3}}));
}

TEST(Inspection, NamesTrianglesOutOfRangeOnEitherSideAndDegenerateOnes) {
  const std::vector<Triangle> triangles{
      {0, 1, 2}, {0, 1, 3}, {-1, 1, 2}, {2, 1, 1}, {std::numeric_limits<Index>::max(), 0, 1}};
  const TopologyReport report = inspect(triangles, 3);
  EXPECT_EQ(report.out_of_range, (std::vector<Index>{1, 2, 4}));
  EXPECT_EQ(report.degenerate, std::vector<Index>{3});
  EXPECT_EQ(report.border.size(), 3u);  // only the valid triangle counts
  EXPECT_FALSE(report.manifold());
}

TEST(Inspection, NamesEdgesOfThreeTrianglesAndTrianglesTurnedOver) {
  const TopologyReport fan = inspect(std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5);
  EXPECT_EQ(fan.non_manifold, (Pairs{{0, 1}}));
  const TopologyReport turned = inspect(std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}}, 4);
  EXPECT_EQ(turned.misoriented, (Pairs{{0, 2}}));
  EXPECT_FALSE(turned.manifold());
}

}  // namespace
}  // namespace weft::mesh
