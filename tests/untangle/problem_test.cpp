// Tests of the threads and neighbours that UntangleInput lists.
#include "physics/untangle/problem.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace weft::untangle {
namespace {

TEST(UntangleInput, OfARopeListsEachPieceAsOneThread) {
  const std::vector<Vec3> x{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.3, 0}};
  collision::Bodies bodies;
  bodies.add(std::vector<collision::Triangle>{{0, 1, 1}, {1, 2, 2}}, 3, {.deformable = true, .thickness = 0.01});
  const std::vector<std::uint8_t> movable(x.size(), 1);
  const UntangleInput input(bodies, {SurfaceKind::cloth}, x, x, movable);
  ASSERT_EQ(input.links.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_FALSE(input.links[k].is_bend);
    EXPECT_DOUBLE_EQ(input.links[k].max_length, k == 0 ? 0.1 : 0.3);
  }
  EXPECT_EQ(input.neighbours, (std::vector<std::vector<Index>>{{1}, {0, 2}, {1}}));
  EXPECT_EQ(stretch_cost(input, std::vector<Move>{{1, x[1]}}, x), 0);
}

}  // namespace
}  // namespace weft::untangle
