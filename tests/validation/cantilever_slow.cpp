// Compares a strip that overhangs its clamp with the heavy elastica: the whole curve, by three routes, for every mesh.
#include <gtest/gtest.h>

#include <cstdio>

#include "validation/cantilever.hpp"
#include "validation/cloth_model.hpp"

namespace weft::simulation {
namespace {

using scene::ClothShape;

class Cantilever : public ::testing::TestWithParam<ClothShape> {};

TEST_P(Cantilever, FollowsTheElasticaHoweverItBecomesHeavy) {
  constexpr int kCells = 40;
  std::printf("%s, %d cells: deviation of H/W by length, rigidity, density\n", testing::name_of(GetParam()), kCells);
  for (const testing::ElasticaPoint& point : testing::kHeavyElastica) {
    std::printf("  gamma %5g:", point.gamma);
    for (testing::Route route : testing::kRoutes) {
      const scene::Scene scene = testing::cantilever(GetParam(), testing::overhang(point.gamma, route), kCells);
      const double error = testing::drop_over_reach_of_run(scene, kCells) / point.drop_over_reach - 1;
      std::printf(" %7.3f %%", 100 * error);
      EXPECT_LT(std::abs(error), 0.01) << "gamma " << point.gamma;
    }
    std::printf("\n");
  }
}

TEST_P(Cantilever, ApproachesTheElasticaInSecondOrder) {
  std::printf("%s: deviation of H/W with 20, 40 and 80 cells, extrapolated, order\n", testing::name_of(GetParam()));
  for (const testing::ElasticaPoint& point : testing::kHeavyElastica) {
    std::vector<double> errors;
    for (int cells : {20, 40, 80}) {
      testing::ClothModel model(
          testing::cantilever(GetParam(), testing::overhang(point.gamma, testing::Route::rigidity), cells));
      model.find_rest(model.free_along({0, 1, 2}));
      errors.push_back(testing::drop_over_reach(model.x, cells) / point.drop_over_reach - 1);
    }
    // The order follows from differences, so that the effect of stretch on the limit cancels.
    const double coarse = errors[0] - errors[1], fine = errors[1] - errors[2];
    const double limit = errors[2] - fine / 3, order = std::log2(std::abs(coarse / fine));
    std::printf("  gamma %5g: %7.3f %% %7.3f %% %7.3f %% -> %7.3f %%  %.2f\n", point.gamma, 100 * errors[0],
                100 * errors[1], 100 * errors[2], 100 * limit, order);
    // Tolerance: 0.05 % of stretch on average at gamma = 100, plus terms of higher order in the extrapolation.
    EXPECT_LT(std::abs(limit), 2e-3) << "gamma " << point.gamma;
    // If the errors are as small as the effect of stretch, no order can be observed.
    if (std::abs(coarse) > 7e-4) {
      EXPECT_GT(order, 1.7) << "gamma " << point.gamma;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Cantilever, ::testing::ValuesIn(testing::kShapes),
                         [](const auto& instance) { return testing::name_of(instance.param); });

}  // namespace
}  // namespace weft::simulation
