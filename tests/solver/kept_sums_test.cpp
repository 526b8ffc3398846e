// Tests of sums over aggregates, which conjugate gradients may reuse in later iterations of Newton's method.
#include <gtest/gtest.h>

#include <array>

#include "physics/solver/conjugate_gradient.hpp"
#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::cut_groups;
using testing::norm;
using testing::Random;
using testing::system_of_parts;

// Sums of an earlier matrix must not be used after the step, because a run that resumes after the step lacks them.
TEST(ConjugateGradient, AggregateSumsAreReusedOnRequestInBothPrecisions) {
  Random random(37);
  LinearSystem system = system_of_parts(random);
  cut_groups(system, {30, 6});
  const auto b = random.vectors(system.matrix.rows());
  const auto stiffen = [&](double by) {
    for (Index i = 20; i < 40; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), by);
    ++system.blocks[1].version;
  };
  const auto solution = [&](ConjugateGradient& cg, double relative_error) {
    std::vector<Vec3> x(b.size());
    cg.solve(b, {relative_error}, 3, x);
    return x;
  };
  for (const double norm_weights : {1e-9, 1.0}) {  // 1e-9: solves use double precision only; 1: both
    system.norm_weights.assign(b.size(), norm_weights);
    ConjugateGradient used;
    used.prepare(system);
    norm(used, b);
    stiffen(1000);
    used.prepare(system, AggregateSums::reuse);
    ConjugateGradient fresh;
    fresh.prepare(system, AggregateSums::reuse);  // no sums exist yet
    EXPECT_NE(norm(used, b), norm(fresh, b));
    // If both precisions are used, double-precision sums do not exist yet, so both solvers compute the same ones.
    EXPECT_EQ(solution(used, 1e-9) == solution(fresh, 1e-9), norm_weights == 1);
    stiffen(1000);
    used.prepare(system);
    ConjugateGradient last;
    last.prepare(system);
    EXPECT_EQ(norm(used, b), norm(last, b));
    // After prepare() without `reuse`, sums in both precisions must be computed again.
    EXPECT_EQ(solution(used, 1e-9), solution(last, 1e-9));
    EXPECT_EQ(solution(used, 0.01), solution(last, 0.01));
  }
}

}  // namespace
}  // namespace weft::solver
