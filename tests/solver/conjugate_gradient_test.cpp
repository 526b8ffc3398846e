// Tests of ConjugateGradient: compares constrained solves with dense direct solutions.
#include "physics/solver/conjugate_gradient.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <array>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::cut_groups;
using testing::dense_with_terms;
using testing::direct_solution;
using testing::norm;
using testing::projection;
using testing::Random;
using testing::system_of_parts;

TEST(ConjugateGradient, AgreesWithTheDirectSolutionUnderContactsAndConstraints) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    constexpr Index kRows = 40;
    const LinearSystem system = testing::random_system(kRows, 30, random);
    const auto b = random.vectors(kRows);
    std::vector<Vec3> x(kRows, Vec3::Constant(7));  // the initial content must not matter

    ConjugateGradient cg;
    cg.prepare(system);
    const LinearReport report = cg.solve(b, {1e-13}, 1000, x);
    EXPECT_TRUE(report.converged);
    EXPECT_TRUE(report.definite);
    const Eigen::VectorXd expected = direct_solution(system, b);
    // Tolerance: 1e-13 in the energy norm, times about 30, the root of the condition number, plus rounding.
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-10 * expected.norm()) << "seed " << seed;
  }
}

TEST(ConjugateGradient, WithAggregatesAgreesWithTheDirectSolutionUnderContactsAndConstraints) {
  constexpr Index kRows = 40;
  for (const std::vector<Index>& counts : {std::vector<Index>{1}, {6}, {kRows}, {20, 6}, {kRows, 20, 10, 3}}) {
    Random random(static_cast<unsigned>(20 + counts.front()));
    LinearSystem system = testing::random_system(kRows, 30, random);
    cut_groups(system, counts);
    const auto b = random.vectors(kRows);
    const auto [x, report] = testing::solved(system, b, {1e-13});
    EXPECT_TRUE(report.converged);
    const Eigen::VectorXd expected = direct_solution(system, b);
    // Tolerance: that of the previous test, times ten for the rounding errors of more levels.
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-9 * expected.norm()) << counts.size() << " levels";
    for (const ParticleConstraint& c : system.constraints) {
      if (c.free.isZero(0)) {
        EXPECT_EQ(x[c.particle], Vec3::Zero());
      }
    }
  }
}

TEST(ConjugateGradient, BlocksAreSolvedAsIfAllOthersWereHeld) {
  for (const std::vector<Index>& counts : {std::vector<Index>{}, {6}, {30, 6}}) {
    Random random(31);
    LinearSystem system = system_of_parts(random);
    cut_groups(system, counts);
    const auto b = random.vectors(system.matrix.rows());
    std::vector<Vec3> x(b.size(), Vec3::Constant(7));
    ConjugateGradient cg;
    cg.prepare(system);
    const std::vector<std::size_t> blocks{0, 2};
    EXPECT_TRUE(cg.solve(b, {1e-13}, 1000, x, {}, blocks).converged);

    const Eigen::VectorXd expected = direct_solution(testing::with_held(system, 20, 40), b);
    EXPECT_LT((testing::flat(x) - expected).norm(), 1e-9 * expected.norm()) << counts.size() << " levels";
    for (std::size_t i = 20; i < 40; ++i) EXPECT_EQ(x[i], Vec3::Zero());
  }
}

TEST(ConjugateGradient, ABlockWithANewVersionIsReadAgain) {
  Random random(33);
  LinearSystem system = system_of_parts(random);
  cut_groups(system, {30, 6});
  const auto b = random.vectors(system.matrix.rows());
  ConjugateGradient used, fresh;
  used.prepare(system);
  for (Index i = 20; i < 40; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 1000);
  ++system.blocks[1].version;
  used.prepare(system);
  fresh.prepare(system);
  EXPECT_EQ(norm(used, b), norm(fresh, b));
}

TEST(ConjugateGradient, AggregatesReduceTheIterationsOnAStiffChain) {
  // A chain of 200 particles. Its springs are a million times stiffer than those that hold each particle in place.
  constexpr Index kRows = 200;
  std::vector<std::pair<Index, Index>> links;
  for (Index i = 1; i < kRows; ++i) links.emplace_back(i - 1, i);
  LinearSystem system;
  system.matrix = BlockMatrix(kRows, links);
  for (Index i = 0; i < kRows; ++i) system.matrix.add(system.matrix.diagonal(i), Mat3::Identity());
  for (const auto& [i, j] : links) system.matrix.add_spring(i, j, 1e6 * Mat3::Identity());
  const auto iterations = [&](const std::vector<Index>& counts) {
    cut_groups(system, counts);
    std::vector<Vec3> b(kRows, Vec3::Zero());
    b[0] = Vec3(0, 0, 1);
    const LinearReport report = testing::solved(system, b, {2e-3}, 10000).report;
    EXPECT_TRUE(report.converged);
    return report.iterations;
  };
  // Without aggregates, the force on particle 0 reaches one more particle in each iteration. With aggregates of ten
  // particles, the number of iterations follows from the condition number of one aggregate. Levels of smaller
  // aggregates reduce it further.
  EXPECT_GE(iterations({}), 190);
  EXPECT_LE(iterations({20}), 39);
  EXPECT_LE(iterations({100, 50, 20}), 30);
}

TEST(ConjugateGradient, WithoutConstraintsAgreesWithTheDirectSolution) {
  Random random(11);
  LinearSystem system = testing::random_system(30, 0, random);
  system.constraints.clear();
  const auto b = random.vectors(30);
  const auto [x, report] = testing::solved(system, b, {1e-13});
  EXPECT_TRUE(report.converged);
  const Eigen::VectorXd expected = testing::dense(system.matrix).ldlt().solve(testing::flat(b));
  EXPECT_LT((testing::flat(x) - expected).norm(), 1e-10 * expected.norm());
}

TEST(ConjugateGradient, PinnedParticlesStayAtExactlyZero) {
  Random random(3);
  LinearSystem system = testing::random_system(40, 30, random);
  // Along axes the projection is exact, so the removed components must be exactly zero.
  system.constraints = {
      {0, Mat3::Zero()}, {5, Vec3(1, 1, 0).asDiagonal()}, {6, Vec3(0, 0, 1).asDiagonal()}, {39, Mat3::Zero()}};
  const auto b = random.vectors(40);
  std::vector<Vec3> x(40);
  ConjugateGradient cg;
  cg.prepare(system);
  for (int iterations : {1, 3, 1000}) {
    cg.solve(b, {1e-12}, iterations, x);
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
  const std::vector<Vec3> x = testing::solved(system, random.vectors(40), {1e-12}).x;
  for (const ParticleConstraint& c : system.constraints) {
    const Vec3& entry = x[c.particle];
    // Tolerance: each of about 100 iterations adds a rounding error.
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
    const Vec3 entry = free * b[i];
    sum += entry.dot(block.inverse() * entry);
  }
  EXPECT_NEAR(norm(cg, b), std::sqrt(sum), 1e-12 * std::sqrt(sum));
}

double energy_norm(const LinearSystem& system, const Eigen::VectorXd& e) {
  return std::sqrt(e.dot(dense_with_terms(system) * e));
}

TEST(ConjugateGradient, KnowsTheErrorThatItLeavesFromItsOwnSteps) {
  for (unsigned seed : {6u, 7u, 8u}) {
    Random random(seed);
    const LinearSystem system = testing::random_system(40, 30, random);
    const auto b = random.vectors(40);
    std::vector<Vec3> x(40);
    ConjugateGradient cg;
    cg.prepare(system);
    const Eigen::VectorXd expected = direct_solution(system, b);
    for (int iterations : {8, 12, 16}) {
      const LinearReport report = cg.solve(b, {}, iterations, x);
      EXPECT_EQ(report.iterations, iterations);
      EXPECT_FALSE(report.converged);
      // The reported error is that of an earlier iterate, so it exceeds the remaining error. In these systems, four
      // iterations divide the error by ten.
      const double error = energy_norm(system, testing::flat(x) - expected);
      EXPECT_GT(report.errors[0], error);
      EXPECT_LT(report.errors[0], 100 * error);
    }
  }
}

TEST(ConjugateGradient, EndsWhenTheErrorOfEachBlockIsSmallEnough) {
  Random random(34);
  LinearSystem system = system_of_parts(random);
  const auto b = random.vectors(system.matrix.rows());
  std::vector<Vec3> x(b.size());
  ConjugateGradient cg;
  cg.prepare(system);
  const Eigen::VectorXd expected = direct_solution(system, b);
  for (const std::vector<double>& allowed : {std::vector<double>{1e-2, 1e-2, 1e-2}, {1e-2, 1e-6, 1e-2}}) {
    EXPECT_TRUE(cg.solve(b, {0, allowed}, 1000, x).converged);
    const Eigen::VectorXd error = testing::flat(x) - expected;
    const Eigen::VectorXd weighed = dense_with_terms(system) * error;
    for (Eigen::Index p = 0; p < 3; ++p)
      EXPECT_LT(error.segment(60 * p, 60).dot(weighed.segment(60 * p, 60)), allowed[p] * allowed[p]) << p;
  }
}

TEST(ConjugateGradient, ErrorsAreMeasuredInTheMassWeightedNorm) {
  // All weights are 1. The stiffness is about 1e8 for particles 0 to 19, and about 1 for the others. In the
  // mass-weighted norm, only the others count, because stiff particles hardly move.
  LinearSystem system;
  constexpr Index kRows = 40;
  system.matrix = BlockMatrix(kRows, {});
  Random random(35);
  for (Index i = 0; i < kRows; ++i) {
    const Mat3 spread = random.definite(0);
    system.matrix.add(system.matrix.diagonal(i), (i < 20 ? 1e8 : 1.0) * (Mat3::Identity() + spread));
  }
  system.norm_weights.assign(kRows, 1);
  // The matrix is block-diagonal: one iteration.
  const auto [x, report] = testing::solved(system, random.vectors(kRows), {}, 1);
  EXPECT_LE(report.errors[0], testing::flat(x).norm() * (1 + 1e-12));
  EXPECT_GT(report.errors[0], 0.99 * testing::flat(x).norm());
}

// A sheet of kSheetSide × kSheetSide particles, with springs of this stiffness between neighbours, bending, and weights
// of 1. The blocks of each row of the matrix sum to the weight.
constexpr Index kSheetSide = 12;
LinearSystem sheet(double stiffness, Random& random) {
  BlockMatrix::Couplings links, bends;
  for (Index i = 0; i < kSheetSide * kSheetSide; ++i) {
    if (i % kSheetSide > 0) links.emplace_back(i - 1, i);
    if (i >= kSheetSide) links.emplace_back(i - kSheetSide, i);
    if (i % kSheetSide > 1) bends.emplace_back(i - 2, i);
  }
  LinearSystem system;
  system.matrix = BlockMatrix(kSheetSide * kSheetSide, links, bends);
  BlockMatrix& matrix = system.matrix;
  for (Index i = 0; i < matrix.rows(); ++i) matrix.add_scalar(matrix.diagonal(i), 1);
  for (const auto& [i, j] : links) {
    const Vec3 n = random.vector().normalized();
    matrix.add_spring(i, j, stiffness * n * n.transpose());
  }
  for (const auto& [i, j] : bends) {
    for (Index k : {i, j}) matrix.add_scalar(matrix.diagonal(k), 0.1);
    matrix.add_scalar(matrix.slot(i, j), -0.1);
    matrix.add_scalar(matrix.slot(j, i), -0.1);
  }
  system.norm_weights.assign(static_cast<std::size_t>(matrix.rows()), 1);
  const Vec3 n = random.vector().normalized();
  system.constraints = {{0, Mat3::Zero()}, {kSheetSide - 1, Mat3::Identity() - n * n.transpose()}};
  system.diagonal_terms = {{30, stiffness * n * n.transpose()}};
  system.terms = {{{50, 75, 76, 87}, {-1, 0.4, 0.3, 0.3}, stiffness * n * n.transpose()}};
  cut_groups(system, {36, 9});
  return system;
}

TEST(ConjugateGradient, InSinglePrecisionIsAsExactAsItSaysAndAsFastAsInDouble) {
  for (const double stiffness : {1.0, 1e3, 1e4}) {
    Random random(51);
    const LinearSystem system = sheet(stiffness, random);
    const auto b = random.vectors(system.matrix.rows());
    const Eigen::VectorXd expected = direct_solution(system, b);
    const Eigen::MatrixXd a = dense_with_terms(system);
    const auto energy = [&](const Eigen::VectorXd& e) { return std::sqrt(e.dot(a * e)); };
    for (const double relative_error : {0.1, 0.01, 1e-3}) {
      std::vector<Vec3> x(b.size()), y(b.size(), Vec3::Zero());
      ConjugateGradient cg;
      cg.prepare(system);
      const LinearReport report = cg.solve(b, {relative_error}, 1000, x);
      Recurrence<double> in_double;
      Progress progress{{{}}};
      in_double.prepare(system, AggregateSums::recompute);
      EXPECT_EQ(in_double.solve(b, {relative_error}, 1000, y, {}, std::array{std::size_t{0}}, progress),
                End::converged);
      EXPECT_TRUE(report.converged);
      // Tolerance: in single precision, search directions lose their conjugacy after some hundred iterations.
      EXPECT_NEAR(report.iterations, progress.iterations, 1 + progress.iterations / (stiffness > 1e3 ? 2.0 : 6.0));
      // The error that single precision adds is below the allowed error.
      EXPECT_LT(energy(testing::flat(x) - expected),
                energy(testing::flat(y) - expected) + relative_error * energy(expected))
          << stiffness << " to " << relative_error;
      EXPECT_EQ(x[0], Vec3::Zero());
      const Vec3 entry = system.constraints[1].free * x[kSheetSide - 1];
      EXPECT_LT((entry - x[kSheetSide - 1]).norm(), 1e-14 * entry.norm());
    }
  }
}

TEST(ConjugateGradient, ContinuesInDoubleWhereSinglePrecisionIsNotEnough) {
  // The goals, a relative error of 1e-10 or an absolute one of 1e-8, are too small for single precision.
  for (const double stiffness : {1e3, 1e6}) {
    Random random(52);
    const LinearSystem system = sheet(stiffness, random);
    const auto b = random.vectors(system.matrix.rows());
    const Eigen::VectorXd expected = direct_solution(system, b);
    for (const double absolute : {0.0, 1e-8}) {
      std::vector<Vec3> x(b.size());
      ConjugateGradient cg;
      cg.prepare(system);
      const double allowed[] = {absolute};
      const LinearGoal goal = absolute > 0 ? LinearGoal{0, allowed} : LinearGoal{1e-10};
      EXPECT_TRUE(cg.solve(b, goal, 5000, x).converged) << stiffness;
      // Tolerance: 1e-8 of the solution, whose norm is about 10.
      EXPECT_LT((testing::flat(x) - expected).norm(), 1e-7) << stiffness;
    }
  }
}

TEST(ConjugateGradient, FreesTheMemoryOfAPrecisionThatIsNoLongerUsed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer has its own malloc";
#endif
  Random random(53);
  const LinearSystem system = sheet(1e3, random);
  const auto b = random.vectors(system.matrix.rows());
  std::vector<Vec3> x(b.size());
  ConjugateGradient cg;
  const auto bytes_after_solve = [&](double relative_error) {
    cg.prepare(system);
    cg.precondition(b);  // in single precision
    cg.solve(b, {relative_error}, 1000, x);
    return static_cast<double>(mallinfo2().uordblks);
  };
  bytes_after_solve(0.1);
  const double of_single = bytes_after_solve(0.1), of_both = bytes_after_solve(1e-10);
  EXPECT_GT(of_both, of_single + 100 * static_cast<double>(b.size()));
  EXPECT_GT(bytes_after_solve(0.1), 0.5 * (of_single + of_both)) << "the next solve may need it again";
  for (int solve = 0; solve < 20; ++solve) bytes_after_solve(0.1);
  EXPECT_LT(bytes_after_solve(0.1), 0.9 * of_single + 0.1 * of_both);
}

TEST(ConjugateGradient, TranslationIsExactInSinglePrecisionHoweverStiffTheThreads) {
  Random random(53);
  LinearSystem system = sheet(1e6, random);
  system.constraints.clear();
  system.terms.clear();
  system.diagonal_terms.clear();
  // The blocks of each row sum to the weight, so this force moves all particles by (1, 2, 3).
  const std::vector<Vec3> b(system.norm_weights.size(), Vec3(1, 2, 3));
  const auto [x, report] = testing::solved(system, b, {0.1}, 100, {.start = b});
  EXPECT_LE(report.iterations, 1);
  // Tolerance: single precision rounds results by 6e-8 of their size. Sums of blocks of size 1e6, in double precision,
  // have a rounding error of 1e-10.
  for (const Vec3& v : x) EXPECT_LT((v - Vec3(1, 2, 3)).norm(), 1e-6);
}

TEST(ConjugateGradient, BeginsWithTheBestMultipleOfADirection) {
  Random random(36);
  const LinearSystem system = testing::random_system(40, 30, random);
  const auto b = random.vectors(40);
  std::vector<Vec3> x(40), exact(40);
  ConjugateGradient cg;
  cg.prepare(system);
  cg.solve(b, {1e-13}, 1000, exact);
  std::vector<Vec3> half = exact;
  for (Vec3& v : half) v *= 0.5;
  const std::vector<double> allowed{1e-8};
  const LinearReport report = cg.solve(b, {0, allowed}, 1000, x, {.start = half});
  EXPECT_LE(report.iterations, 1);
  EXPECT_LT((testing::flat(x) - testing::flat(exact)).norm(), 1e-10 * testing::flat(exact).norm());
  // A random direction is also possible: the solver removes its components that constraints forbid, and scales it.
  const std::vector<Vec3> elsewhere = random.vectors(40);
  EXPECT_TRUE(cg.solve(b, {1e-13}, 1000, x, {.start = elsewhere}).converged);
  EXPECT_LT((testing::flat(x) - testing::flat(exact)).norm(), 1e-10 * testing::flat(exact).norm());
}

TEST(ConjugateGradient, NeedsNoMoreIterationsThanThereAreEigenvalues) {
  // A chain of springs, isotropic: 60 distinct eigenvalues, condition number about 1500. Steepest descent would need
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
  const LinearReport report = testing::solved(system, random.vectors(kRows), {1e-8}).report;
  EXPECT_TRUE(report.converged);
  // The error of an iterate is known only after further iterations, here about a fifth of all.
  EXPECT_LE(report.iterations, kRows + kRows / 4);
}

TEST(ConjugateGradient, NothingToSolveIsSolvedWithoutAnIteration) {
  Random random(7);
  const LinearSystem system = testing::random_system(8, 0, random);
  const std::vector<Vec3> b(8, Vec3::Zero());
  std::vector<Vec3> x(8, Vec3::Ones());
  ConjugateGradient cg;
  cg.prepare(system);
  const LinearReport report = cg.solve(b, {}, 10, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, b);
}

TEST(ConjugateGradient, NegativeCurvatureIsReported) {
  LinearSystem system;
  system.matrix = BlockMatrix(2, {{0, 1}});
  for (Index i : {0, 1}) system.matrix.add_scalar(system.matrix.diagonal(i), 1);
  // The eigenvalues are 1 ± 2.
  system.matrix.add_scalar(system.matrix.slot(0, 1), 2);
  system.matrix.add_scalar(system.matrix.slot(1, 0), 2);
  const std::vector<Vec3> b{Vec3(1, 0, 0), Vec3(-1, 0, 0)};
  const LinearReport report = testing::solved(system, b, {1e-6}, 10).report;
  EXPECT_FALSE(report.definite);
  EXPECT_FALSE(report.converged);
}

TEST(ConjugateGradient, GivesTheSameBitsOnAnyNumberOfThreads) {
  // So many rows that they form several chunks for the threads; the last chunk is not full.
  constexpr Index kRows = 3500;
  Random random(8);
  const LinearSystem system = testing::random_system(kRows, 400, random);
  const auto b = random.vectors(kRows);
  std::vector<std::vector<Vec3>> solutions;
  std::vector<LinearReport> reports;
  for (int threads : {1, 2, 3, 2}) {
    set_thread_count(threads);
    const auto [x, report] = testing::solved(system, b, {1e-6}, 200);
    reports.push_back(report);
    solutions.push_back(x);
  }
  set_thread_count(0);
  EXPECT_GT(reports.front().iterations, 10);
  for (std::size_t run = 1; run < solutions.size(); ++run) {
    EXPECT_EQ(solutions[run], solutions[0]);
    EXPECT_EQ(reports[run].errors, reports[0].errors);
    EXPECT_EQ(reports[run].iterations, reports[0].iterations);
  }
}

}  // namespace
}  // namespace weft::solver
