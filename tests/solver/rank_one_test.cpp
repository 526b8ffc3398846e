// Tests of rank-one terms, in the product with the matrix and in the preconditioner.
#include "physics/solver/rank_one.hpp"

#include <gtest/gtest.h>

#include "physics/solver/conjugate_gradient.hpp"
#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::cut_groups;
using testing::direct_solution;
using testing::flat;
using testing::Random;

void add_term(LinearSystem& system, Index begin, Index end, double stiffness, Random& random) {
  system.rank_one_terms.push_back({begin, random.vectors(end - begin), stiffness});
}

TEST(RankOneTerms, AreSolvedExactlyHoweverStiffTheyAre) {
  for (const double stiffness : {1e-3, 1.0, 1e3, 1e6})
    for (const std::vector<Index>& counts : {std::vector<Index>{}, {20, 6}}) {
      Random random(3);
      constexpr Index kRows = 40;
      LinearSystem system = testing::random_system(kRows, 30, random);
      cut_groups(system, counts);
      add_term(system, 0, kRows, stiffness, random);
      add_term(system, 0, kRows, 10 * stiffness, random);
      const auto b = random.vectors(kRows);
      const auto [x, report] = testing::solved(system, b, {1e-13});
      EXPECT_TRUE(report.converged);
      const Eigen::VectorXd expected = direct_solution(system, b);
      EXPECT_LT((flat(x) - expected).norm(), 1e-9 * expected.norm()) << stiffness;  // measured: 1e-10
    }
}

TEST(RankOneTerms, TakeNoMoreIterationsWhereTheyAreStiff) {
  const auto iterations = [](double stiffness) {
    Random random(7);
    constexpr Index kRows = 200;
    LinearSystem system = testing::random_system(kRows, 100, random);
    cut_groups(system, {50, 12});
    if (stiffness > 0) add_term(system, 0, kRows, stiffness, random);
    const LinearReport report = testing::solved(system, random.vectors(kRows), {1e-3}).report;
    EXPECT_TRUE(report.converged && report.definite);
    return report.iterations;
  };
  const int without = iterations(0);
  for (const double stiffness : {1e-2, 1e2, 1e6}) EXPECT_LE(iterations(stiffness), without + 3) << stiffness;
}

TEST(RankOneTerms, OfOtherPartsDoNotCountAndThoseOfOwnPartsDo) {
  Random random(31);
  LinearSystem system = testing::system_of_parts(random);
  cut_groups(system, {30, 6});
  for (const DiagonalBlock& part : std::vector<DiagonalBlock>(system.blocks))
    add_term(system, part.begin, part.end, 1e3, random);
  const auto b = random.vectors(system.matrix.rows());
  std::vector<Vec3> x(b.size());
  ConjugateGradient cg;
  cg.prepare(system);
  const std::vector<std::size_t> chosen{1};
  EXPECT_TRUE(cg.solve(b, {1e-13}, 1000, x, {}, chosen).converged);
  // Expected: the solution of the same system with all particles of other diagonal blocks held.
  const LinearSystem held = testing::with_held(testing::with_held(system, 0, 20), 40, 60);
  const Eigen::VectorXd expected = direct_solution(held, b);
  EXPECT_LT((flat(x) - expected).norm(), 1e-9 * expected.norm());
}

}  // namespace
}  // namespace weft::solver
