// Constrained conjugate gradients against a dense direct solution.
#include "solver/conjugate_gradient.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.hpp"
#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::cut_groups;
using testing::dense_with_terms;
using testing::projection;
using testing::Random;

Eigen::VectorXd direct_solution(const LinearSystem& system, std::span<const Vec3> b) {
  const Eigen::MatrixXd s = projection(system);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
  const Eigen::MatrixXd filtered = s * dense_with_terms(system) * s + (identity - s);
  return filtered.ldlt().solve(s * testing::flat(b));
}

TEST(ConjugateGradient, AgreesWithTheDirectSolutionUnderContactsAndConstraints) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    constexpr Index kRows = 40;
    const LinearSystem system = testing::random_system(kRows, 30, random);
    const auto b = random.vectors(kRows);
    std::vector<Vec3> x(kRows, Vec3::Constant(7));  // what is there must not matter

    ConjugateGradient cg;
    cg.prepare(system);
    const LinearReport report = cg.solve(b, 1e-13 * cg.norm(b), 1000, x);
    EXPECT_TRUE(report.converged);
    EXPECT_TRUE(report.definite);
    const Eigen::VectorXd expected = direct_solution(system, b);
    // Residual 1e-13 in the preconditioned norm, times the condition number of that system, about 1e3.
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-10 * expected.norm()) << "seed " << seed;
  }
}

TEST(ConjugateGradient, WithGroupsAgreesWithTheDirectSolutionUnderContactsAndConstraints) {
  constexpr Index kRows = 40;
  for (const std::vector<Index>& counts : {std::vector<Index>{1}, {6}, {kRows}, {20, 6}, {kRows, 20, 10, 3}}) {
    Random random(static_cast<unsigned>(20 + counts.front()));
    LinearSystem system = testing::random_system(kRows, 30, random);
    cut_groups(system, counts);
    const auto b = random.vectors(kRows);
    std::vector<Vec3> x(kRows);
    ConjugateGradient cg;
    cg.prepare(system);
    EXPECT_TRUE(cg.solve(b, 1e-13 * cg.norm(b), 1000, x).converged);
    const Eigen::VectorXd expected = direct_solution(system, b);
    // As above, and ten times that for the rounding that a held group's small stand-in value lets through.
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-9 * expected.norm()) << counts.size() << " levels";
    for (const ParticleConstraint& c : system.constraints) {
      if (c.free.isZero(0)) {
        EXPECT_EQ(x[static_cast<std::size_t>(c.particle)], Vec3::Zero());
      }
    }
  }
}

// Three parts of twenty particles, coupled by contacts alone.
LinearSystem system_of_parts(Random& random) {
  constexpr Index kRows = 60, kPart = 20;
  LinearSystem system = testing::random_system(kRows, 30, random);
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 0; i < kRows; ++i)
    for (Index j = kPart * (i / kPart); j < i; ++j)
      if (random.below(5) == 0) couplings.emplace_back(i, j);
  system.matrix = BlockMatrix(kRows, couplings);
  for (Index i = 0; i < kRows; ++i) system.matrix.add(system.matrix.diagonal(i), random.definite(20));
  for (const auto& [i, j] : couplings) {
    const Mat3 block = random.definite(0);
    system.matrix.add(system.matrix.slot(i, j), block);
    system.matrix.add(system.matrix.slot(j, i), block);
  }
  for (Index p = 0; p < 3; ++p) system.parts.push_back({kPart * p, kPart * (p + 1)});
  return system;
}

TEST(ConjugateGradient, PartsAreSolvedAsIfAllOthersWereHeld) {
  for (const std::vector<Index>& counts : {std::vector<Index>{}, {6}, {30, 6}}) {
    Random random(31);
    LinearSystem system = system_of_parts(random);
    cut_groups(system, counts);
    const auto b = random.vectors(system.matrix.rows());
    std::vector<Vec3> x(b.size(), Vec3::Constant(7));
    ConjugateGradient cg;
    cg.prepare(system);
    const std::vector<std::size_t> parts{0, 2};
    EXPECT_TRUE(cg.solve(b, 1e-13 * cg.norm(b), 1000, x, parts).converged);

    LinearSystem held = system;
    std::erase_if(held.constraints, [](const auto& c) { return c.particle >= 20 && c.particle < 40; });
    for (Index i = 20; i < 40; ++i) held.constraints.push_back({i, Mat3::Zero()});
    const Eigen::VectorXd expected = direct_solution(held, b);
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-9 * expected.norm()) << counts.size() << " levels";
    for (std::size_t i = 20; i < 40; ++i) EXPECT_EQ(x[i], Vec3::Zero());
  }
}

TEST(ConjugateGradient, NormsOfPartsAddUpToTheNorm) {
  Random random(32);
  LinearSystem system = system_of_parts(random);
  cut_groups(system, {30, 6});
  auto b = random.vectors(system.matrix.rows());
  ConjugateGradient cg;
  cg.prepare(system);
  cg.filter(b);
  double sum = 0;
  for (double norm_sq : cg.part_norms_sq(b)) {
    EXPECT_GT(norm_sq, 0);
    sum += norm_sq;
  }
  EXPECT_NEAR(sum, cg.norm(b) * cg.norm(b), 1e-12 * sum);  // 60 terms, rounded
}

TEST(ConjugateGradient, APartWithAnotherVersionIsReadAnew) {
  Random random(33);
  LinearSystem system = system_of_parts(random);
  cut_groups(system, {30, 6});
  const auto b = random.vectors(system.matrix.rows());
  ConjugateGradient used, fresh;
  used.prepare(system);
  for (Index i = 20; i < 40; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 1000);
  ++system.parts[1].version;
  used.prepare(system);
  fresh.prepare(system);
  EXPECT_EQ(used.norm(b), fresh.norm(b));
}

TEST(ConjugateGradient, GroupsCarryAPushAlongAStiffChainInFewerIterations) {
  // A free chain of 200 particles, springs a million times stiffer than what holds a particle in its place.
  constexpr Index kRows = 200;
  std::vector<std::pair<Index, Index>> links;
  for (Index i = 1; i < kRows; ++i) links.emplace_back(i - 1, i);
  LinearSystem system;
  system.matrix = BlockMatrix(kRows, links);
  for (Index i = 0; i < kRows; ++i) system.matrix.add(system.matrix.diagonal(i), Mat3::Identity());
  for (const auto& [i, j] : links) {
    const Mat3 spring = 1e6 * Mat3::Identity();
    system.matrix.add(system.matrix.diagonal(i), spring);
    system.matrix.add(system.matrix.diagonal(j), spring);
    system.matrix.subtract(system.matrix.slot(i, j), spring);
    system.matrix.subtract(system.matrix.slot(j, i), spring);
  }
  const auto iterations = [&](const std::vector<Index>& counts) {
    cut_groups(system, counts);
    std::vector<Vec3> b(kRows, Vec3::Zero()), x(kRows);
    b[0] = Vec3(0, 0, 1);
    ConjugateGradient cg;
    cg.prepare(system);
    const LinearReport report = cg.solve(b, 2e-3 * cg.norm(b), 10000, x);
    EXPECT_TRUE(report.converged);
    return report.iterations;
  };
  // One level: an iteration per particle that the push has to reach, 199, were it not for the factor from the 40th on,
  // which along a chain is exact. Two: the condition number of a group of ten. More: what is between the two has groups
  // of its own.
  EXPECT_GE(iterations({}), 40);
  EXPECT_LE(iterations({}), 42);
  EXPECT_LE(iterations({20}), 39);
  EXPECT_LE(iterations({100, 50, 20}), 30);
}

TEST(ConjugateGradient, WithoutConstraintsAgreesWithTheDirectSolution) {
  Random random(11);
  LinearSystem system = testing::random_system(30, 0, random);
  system.constraints.clear();
  const auto b = random.vectors(30);
  std::vector<Vec3> x(30);
  ConjugateGradient cg;
  cg.prepare(system);
  EXPECT_TRUE(cg.solve(b, 1e-13 * cg.norm(b), 1000, x).converged);
  const Eigen::VectorXd expected = testing::dense(system.matrix).ldlt().solve(testing::flat(b));
  EXPECT_LT((testing::flat(x) - expected).norm(), 1e-10 * expected.norm());
}

TEST(ConjugateGradient, PinnedParticlesStayAtExactlyZero) {
  Random random(3);
  LinearSystem system = testing::random_system(40, 30, random);
  // Along axes the projection itself is exact, so what it takes away has to be exactly zero.
  system.constraints = {
      {0, Mat3::Zero()}, {5, Vec3(1, 1, 0).asDiagonal()}, {6, Vec3(0, 0, 1).asDiagonal()}, {39, Mat3::Zero()}};
  const auto b = random.vectors(40);
  std::vector<Vec3> x(40);
  ConjugateGradient cg;
  cg.prepare(system);
  for (int iterations : {1, 3, 1000}) {
    cg.solve(b, 1e-12 * cg.norm(b), iterations, x);
    EXPECT_EQ(x[0], Vec3(Vec3::Zero()));
    EXPECT_EQ(x[39], Vec3(Vec3::Zero()));
    EXPECT_EQ(x[5].z(), 0.0);
    EXPECT_EQ(x[6].x(), 0.0);
    EXPECT_EQ(x[6].y(), 0.0);
    EXPECT_NE(x[5].x(), 0.0);
    EXPECT_NE(x[6].z(), 0.0);
  }
}

TEST(ConjugateGradient, ObliqueConstraintsAreKeptToRounding) {
  Random random(4);
  const LinearSystem system = testing::random_system(40, 30, random);
  const auto b = random.vectors(40);
  std::vector<Vec3> x(40);
  ConjugateGradient cg;
  cg.prepare(system);
  cg.solve(b, 1e-12 * cg.norm(b), 1000, x);
  for (const ParticleConstraint& c : system.constraints) {
    const Vec3& entry = x[static_cast<std::size_t>(c.particle)];
    // Each of some 100 iterations adds a direction that is off by a rounding.
    EXPECT_LE((entry - c.free * entry).norm(), 1e-14 * std::max(1.0, entry.norm()));
  }
}

TEST(ConjugateGradient, NormIsThatOfTheInverseBlockDiagonalOnTheFreeDirections) {
  Random random(5);
  const LinearSystem system = testing::random_system(21, 10, random);
  const auto b = random.vectors(21);
  ConjugateGradient cg;
  cg.prepare(system);

  const Eigen::MatrixXd a = dense_with_terms(system), s = projection(system);
  double sum = 0;
  for (Index i = 0; i < 21; ++i) {
    const Mat3 free = s.block<3, 3>(3 * i, 3 * i);
    const Mat3 block = free * a.block<3, 3>(3 * i, 3 * i) * free + (Mat3::Identity() - free);
    const Vec3 entry = free * b[static_cast<std::size_t>(i)];
    sum += entry.dot(block.inverse() * entry);
  }
  EXPECT_NEAR(cg.norm(b), std::sqrt(sum), 1e-12 * std::sqrt(sum));

  // The part that constraints take away does not count.
  auto filtered = b;
  cg.filter(filtered);
  EXPECT_NEAR(cg.norm(filtered), cg.norm(b), 1e-12 * cg.norm(b));
}

TEST(ConjugateGradient, ReportsTheResidualThatIsLeft) {
  Random random(6);
  const LinearSystem system = testing::random_system(40, 30, random);
  const auto b = random.vectors(40);
  std::vector<Vec3> x(40);
  ConjugateGradient cg;
  cg.prepare(system);
  const LinearReport report = cg.solve(b, 0, 8, x);
  EXPECT_EQ(report.iterations, 8);
  EXPECT_FALSE(report.converged);
  EXPECT_NEAR(report.first_residual, cg.norm(b), 1e-12 * cg.norm(b));
  const Eigen::VectorXd left = testing::flat(b) - dense_with_terms(system) * testing::flat(x);
  std::vector<Vec3> residual(40);
  for (Eigen::Index i = 0; i < 40; ++i) residual[static_cast<std::size_t>(i)] = left.segment<3>(3 * i);
  EXPECT_NEAR(report.last_residual, cg.norm(residual), 1e-10 * report.first_residual);
}

TEST(ConjugateGradient, NeedsNoMoreIterationsThanThereAreEigenvalues) {
  // A chain of springs, the same along all axes: 60 eigenvalues, of condition about 1500. Steepest descent would need
  // thousands of iterations.
  constexpr Index kRows = 60;
  LinearSystem system;
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 0; i + 1 < kRows; ++i) couplings.emplace_back(i, i + 1);
  system.matrix = BlockMatrix(kRows, couplings);
  for (Index i = 0; i < kRows; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 2);
  for (const auto& [i, j] : couplings) {
    system.matrix.add_scalar(system.matrix.slot(i, j), -1);
    system.matrix.add_scalar(system.matrix.slot(j, i), -1);
  }
  Random random(9);
  const auto b = random.vectors(kRows);
  std::vector<Vec3> x(kRows);
  ConjugateGradient cg;
  cg.prepare(system);
  const LinearReport report = cg.solve(b, 1e-8 * cg.norm(b), 1000, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, kRows);
}

TEST(ConjugateGradient, NothingToSolveIsSolvedWithoutAnIteration) {
  Random random(7);
  const LinearSystem system = testing::random_system(8, 0, random);
  const std::vector<Vec3> b(8, Vec3::Zero());
  std::vector<Vec3> x(8, Vec3::Ones());
  ConjugateGradient cg;
  cg.prepare(system);
  const LinearReport report = cg.solve(b, 0, 10, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, b);
}

TEST(ConjugateGradient, NegativeCurvatureIsReported) {
  LinearSystem system;
  system.matrix = BlockMatrix(2, {{0, 1}});
  for (Index i : {0, 1}) system.matrix.add_scalar(system.matrix.diagonal(i), 1);
  // Eigenvalues 1 ± 2.
  system.matrix.add_scalar(system.matrix.slot(0, 1), 2);
  system.matrix.add_scalar(system.matrix.slot(1, 0), 2);
  const std::vector<Vec3> b{Vec3(1, 0, 0), Vec3(-1, 0, 0)};
  std::vector<Vec3> x(2);
  ConjugateGradient cg;
  cg.prepare(system);
  const LinearReport report = cg.solve(b, 1e-6, 10, x);
  EXPECT_FALSE(report.definite);
  EXPECT_FALSE(report.converged);
}

TEST(ConjugateGradient, GivesTheSameBitsOnAnyNumberOfThreads) {
  // Several chunks of rows, the last one not full.
  constexpr Index kRows = 3500;
  Random random(8);
  const LinearSystem system = testing::random_system(kRows, 400, random);
  const auto b = random.vectors(kRows);
  std::vector<std::vector<Vec3>> solutions;
  std::vector<LinearReport> reports;
  for (int threads : {1, 2, 3, 2}) {
    set_thread_count(threads);
    std::vector<Vec3> x(kRows);
    ConjugateGradient cg;
    cg.prepare(system);
    reports.push_back(cg.solve(b, 1e-6 * cg.norm(b), 200, x));
    solutions.push_back(x);
  }
  set_thread_count(0);
  EXPECT_GT(reports.front().iterations, 10);
  for (std::size_t run = 1; run < solutions.size(); ++run) {
    EXPECT_EQ(solutions[run], solutions[0]);
    EXPECT_EQ(reports[run].last_residual, reports[0].last_residual);
    EXPECT_EQ(reports[run].iterations, reports[0].iterations);
  }
}

}  // namespace
}  // namespace weft::solver
