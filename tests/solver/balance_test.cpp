// Tests of Recurrence::balance(): residuals of truncated solves do no work along the motion, and have no resultant on
// blocks without held particles.
#include <gtest/gtest.h>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::dense_with_terms;
using testing::flat;
using testing::Random;
using testing::system_of_parts;

/// Three blocks of twenty rows with terms between them; the first and the last have no held particles.
LinearSystem system_with_free_parts(Random& random) {
  LinearSystem system = system_of_parts(random);
  std::erase_if(system.constraints, [](const auto& c) { return c.particle < 20 || c.particle >= 40; });
  return system;
}

Vec3 sum_of(const Eigen::VectorXd& forces, Index begin, Index end) {
  Vec3 sum = Vec3::Zero();
  for (Index i = begin; i < end; ++i) sum += forces.segment<3>(3 * i);
  return sum;
}

struct Left {
  Eigen::VectorXd forces;  // residual in the free directions
  double work = 0;         // of the residual, along `motion` plus the solution
  double error = 0;        // of the solution, in the energy norm
};

Left left_by(const LinearSystem& system, std::span<const Vec3> b, std::span<const Vec3> motion,
             std::span<const Vec3> x) {
  const Eigen::MatrixXd s = testing::projection(system), a = dense_with_terms(system);
  Left left;
  left.forces = s * (flat(b) - a * flat(x));
  left.work = left.forces.dot(flat(motion) + flat(x));
  const Eigen::VectorXd error = flat(x) - testing::direct_solution(system, b);
  left.error = std::sqrt(error.dot(a * error));
  return left;
}

TEST(Balance, LeavesNoResultantOnFreePartsAndDoesNoWork) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    LinearSystem system = system_with_free_parts(random);
    for (Index begin : {0, 20}) system.rank_one_terms.push_back({begin, random.vectors(20), 0.5});
    const auto b = random.vectors(system.matrix.rows()), motion = random.vectors(system.matrix.rows()),
               drift = random.vectors(system.matrix.rows());
    for (const bool single : {false, true}) {
      system.norm_weights.assign(single ? b.size() : 0, 1.0);
      ConjugateGradient cg;
      cg.prepare(system);
      std::vector<Vec3> x(b.size()), without(b.size());
      cg.solve(b, {}, 4, without);
      cg.solve(b, {}, 4, x, {.motion = motion, .drift = drift});
      const Left balanced = left_by(system, b, motion, x), early = left_by(system, b, motion, without);
      // Tolerance: single precision rounds forces of size 1, on twenty rows with stiffnesses up to 100, by 6e-8.
      const double roundings = single ? 1e-4 : 1e-11;
      EXPECT_LT(sum_of(balanced.forces, 0, 20).norm(), roundings);
      EXPECT_LT(sum_of(balanced.forces, 40, 60).norm(), roundings);
      EXPECT_LT(std::abs(balanced.work), roundings);
      EXPECT_LT(std::abs(balanced.forces.dot(flat(drift))), roundings);
      EXPECT_GT(sum_of(early.forces, 0, 20).norm(), 10 * roundings);
      EXPECT_GT(std::abs(early.work), 10 * roundings);
      EXPECT_GT(std::abs(early.forces.dot(flat(drift))), 10 * roundings);
      EXPECT_LT(balanced.error, early.error);
      cg.solve(b, {}, 4, x, {.motion = motion, .drift = drift});
      EXPECT_LT((flat(cg.residual()) - balanced.forces).norm(), 10 * roundings);
    }
  }
}

TEST(Balance, LeavesConstrainedDirectionsAndOtherPartsAsTheyAre) {
  Random random(7);
  const LinearSystem system = system_of_parts(random);
  const auto b = random.vectors(system.matrix.rows()), motion = random.vectors(system.matrix.rows());
  std::vector<Vec3> x(b.size());
  ConjugateGradient cg;
  cg.prepare(system);
  const std::vector<std::size_t> blocks{0, 2};
  cg.solve(b, {}, 4, x, {.motion = motion}, blocks);
  for (std::size_t i = 20; i < 40; ++i) EXPECT_EQ(x[i], Vec3::Zero());
  for (const ParticleConstraint& c : system.constraints) {
    const Vec3& entry = x[c.particle];
    EXPECT_LT((entry - c.free * entry).norm(), 1e-14 * (1 + entry.norm()));
  }
}

// precondition() computes values for all blocks. They must not enter the balance of a solve for some blocks.
TEST(Balance, OfSomeBlocksDoesNotDependOnEarlierCalls) {
  Random random(9);
  const LinearSystem system = system_of_parts(random);
  const Index rows = system.matrix.rows();
  const auto b = random.vectors(rows), motion = random.vectors(rows), drift = random.vectors(rows);
  const std::vector<std::size_t> blocks{0, 2};
  const auto solution = [&](bool precondition_first) {
    ConjugateGradient cg;
    cg.prepare(system);
    if (precondition_first) cg.precondition(b);
    std::vector<Vec3> x(b.size());
    cg.solve(b, {}, 4, x, {.motion = motion, .drift = drift}, blocks);
    return x;
  };
  EXPECT_EQ(solution(true), solution(false));
}

// If the motion is a translation, no work along the motion follows from no resultant: two of the conditions coincide.
TEST(Balance, OfATranslationIsThatOfItsForcesAlone) {
  for (const bool single : {false, true}) {
    Random random(8);
    LinearSystem system = system_with_free_parts(random);
    system.constraints.clear();
    system.terms.clear();
    const auto b = random.vectors(system.matrix.rows());
    system.norm_weights.assign(single ? b.size() : 0, 1.0);
    const std::vector<Vec3> motion(b.size(), Vec3(1e3, 2e3, 3e3));
    std::vector<Vec3> x(b.size());
    ConjugateGradient cg;
    cg.prepare(system);
    cg.solve(b, {}, 4, x, {.motion = motion});
    const Left left = left_by(system, b, std::vector<Vec3>(b.size(), Vec3::Zero()), x);
    // Tolerance: that of the first test, times a hundred, because the motion is a thousand times as large.
    for (Index begin : {0, 20, 40}) EXPECT_LT(sum_of(left.forces, begin, begin + 20).norm(), single ? 0.01 : 1e-9);
    for (const Vec3& v : x) EXPECT_LT(v.norm(), 10);
  }
}

}  // namespace
}  // namespace weft::solver
