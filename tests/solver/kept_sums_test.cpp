// Sums over groups that conjugate gradients keep from one iteration of Newton's method to the next.
#include <gtest/gtest.h>

#include <array>

#include "solver/block_systems.hpp"
#include "solver/conjugate_gradient.hpp"

namespace weft::solver {
namespace {

using testing::cut_groups;
using testing::norm;
using testing::Random;
using testing::system_of_parts;

// What was kept of an earlier matrix must not outlive the step: a run that is resumed there has none of it.
TEST(ConjugateGradient, SumsAreKeptUntilTheyAreToBeMadeAnewInBothPrecisions) {
  Random random(37);
  LinearSystem system = system_of_parts(random);
  cut_groups(system, {30, 6});
  const auto b = random.vectors(system.matrix.rows());
  const auto stiffen = [&](double by) {
    for (Index i = 20; i < 40; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), by);
    ++system.parts[1].version;
  };
  const auto solution = [&](ConjugateGradient& cg, double share) {
    std::vector<Vec3> x(b.size());
    cg.solve(b, {share}, 3, x);
    return x;
  };
  for (const double metric : {1e-9, 1.0}) {  // in double only, and in both
    system.metric.assign(b.size(), metric);
    ConjugateGradient used;
    used.prepare(system);
    norm(used, b);
    stiffen(1000);
    used.prepare(system, Sums::kept);
    ConjugateGradient fresh;
    fresh.prepare(system, Sums::kept);  // nothing is there to be kept
    EXPECT_NE(norm(used, b), norm(fresh, b));
    // Double has not been used before where single precision is.
    EXPECT_EQ(solution(used, 1e-9) == solution(fresh, 1e-9), metric == 1);
    stiffen(1000);
    used.prepare(system);
    ConjugateGradient last;
    last.prepare(system);
    EXPECT_EQ(norm(used, b), norm(last, b));
    // Single precision has summed up already, where it is used: double has to do so for itself.
    EXPECT_EQ(solution(used, 1e-9), solution(last, 1e-9));
    EXPECT_EQ(solution(used, 0.01), solution(last, 0.01));
  }
}

}  // namespace
}  // namespace weft::solver
