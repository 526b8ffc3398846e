// Compares the incomplete factor with dense algebra.
#include "solver/incomplete_cholesky.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/parallel.hpp"
#include "solver/block_systems.hpp"
#include "solver/conjugate_gradient.hpp"

namespace weft::solver {
namespace {

using testing::projection;
using testing::Random;

// What the factor adds to z for each unit of r that satisfies the constraints, as a matrix: S (L Lᵀ)⁻¹ S.
Eigen::MatrixXd dense_inverse(IncompleteCholesky& factor, const LinearSystem& system, const Eigen::MatrixXd& s) {
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  Eigen::MatrixXd inverse(s.rows(), s.cols());
  for (Eigen::Index column = 0; column < s.cols(); ++column) {
    std::vector<Vec3> r(rows);
    for (std::size_t i = 0; i < rows; ++i) r[i] = s.col(column).segment<3>(static_cast<Eigen::Index>(3 * i));
    std::vector<PaddedVec3<double>> padded_rows(rows, PaddedVec3<double>{});
    const double sum = factor.add(1, testing::quads(r), padded_rows, parts_of(system));
    const std::vector<Vec3> z = testing::vectors(padded_rows);
    inverse.col(column) = s * testing::flat(z);
    EXPECT_NEAR(sum, testing::flat(r).dot(testing::flat(z)), 1e-12 * (1 + std::abs(sum)));
  }
  return inverse;
}

// A chain has no fill-in, so its factor is complete.
LinearSystem chain(Index rows, Random& random) {
  std::vector<std::pair<Index, Index>> links;
  for (Index i = 1; i < rows; ++i) links.emplace_back(i - 1, i);
  LinearSystem system;
  system.matrix = BlockMatrix(rows, links);
  for (Index i = 0; i < rows; ++i) system.matrix.add(system.matrix.diagonal(i), random.definite(0.1));
  for (const auto& [i, j] : links) {
    const Mat3 spring = 1000 * random.definite(0);
    for (Index k : {i, j}) system.matrix.add(system.matrix.diagonal(k), spring);
    system.matrix.subtract(system.matrix.slot(i, j), spring);
    system.matrix.subtract(system.matrix.slot(j, i), spring);
  }
  return system;
}

TEST(IncompleteCholesky, IsExactWhereNothingFillsIn) {
  Random random(1);
  LinearSystem system = chain(30, random);
  const Vec3 n = random.vector().normalized();
  const Mat3 line = n * n.transpose();
  system.constraints = {{0, Mat3::Zero()}, {9, line}, {20, Mat3::Identity() - line}};
  // Contacts with an obstacle; one is a stencil of a single particle.
  system.diagonal_terms.push_back({5, 50 * line});
  system.terms.push_back({{12, 0, 0, 0}, {0.5, 0, 0, 0}, 50 * line});

  IncompleteCholesky factor;
  ASSERT_TRUE(factor.factorise(system));
  const Eigen::MatrixXd s = projection(system), identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
  Eigen::MatrixXd a = testing::dense(system.matrix);
  a.block<3, 3>(15, 15) += 50 * line;
  a.block<3, 3>(36, 36) += 0.25 * 50 * line;
  const Eigen::MatrixXd expected = s * (s * a * s + identity - s).inverse() * s;
  // Condition number 1e5 times rounding of 1e-16, times a factor of ten.
  EXPECT_LT((dense_inverse(factor, system, s) - expected).norm(), 1e-10 * expected.norm());
}

TEST(IncompleteCholesky, IsSymmetricAndPositiveDefiniteOnTheFreeDirections) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const LinearSystem system = testing::random_system(40, 30, random);
    IncompleteCholesky factor;
    ASSERT_TRUE(factor.factorise(system));
    const Eigen::MatrixXd s = projection(system), inverse = dense_inverse(factor, system, s);
    EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-12 * inverse.norm()) << "seed " << seed;
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse + (identity - s));
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 1e-6) << "seed " << seed;  // blocks are below 1e4
  }
}

TEST(IncompleteCholesky, AMatrixWhosePivotsFailTakesALargerDiagonal) {
  // A ring of four: definite, but singular once the fill-in is dropped. With 1 on the diagonal and c with signs +, +,
  // +, − on the links, its eigenvalues are 1 ± √2 c, but the last pivot without fill-in is 1 − 2 c² / (1 − c²).
  constexpr double c = 0.65;
  LinearSystem system;
  system.matrix = BlockMatrix(4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
  for (Index i = 0; i < 4; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 1);
  for (Index i = 0; i < 4; ++i) {
    const Index j = (i + 1) % 4;
    const double value = i == 3 ? -c : c;
    system.matrix.add_scalar(system.matrix.slot(i, j), value);
    system.matrix.add_scalar(system.matrix.slot(j, i), value);
  }
  ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(testing::dense(system.matrix)).eigenvalues().minCoeff(), 0);
  IncompleteCholesky factor;
  ASSERT_TRUE(factor.factorise(system));
  const Eigen::MatrixXd inverse = dense_inverse(factor, system, projection(system));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inverse).eigenvalues().minCoeff(), 0);
}

TEST(IncompleteCholesky, ValuesThatAreNotFiniteAreRefused) {
  Random random(2);
  LinearSystem system = chain(5, random);
  system.matrix.add_scalar(system.matrix.diagonal(3), std::numeric_limits<double>::quiet_NaN());
  IncompleteCholesky factor;
  EXPECT_FALSE(factor.factorise(system));
}

TEST(IncompleteCholesky, SavesIterationsOnStiffThreadsAndGivesTheSameBitsOnAnyNumberOfThreads) {
  // A sheet of 80 × 80 with threads 1e5 times stiffer than what holds a particle, each in its own direction.
  constexpr Index kSide = 80, kRows = kSide * kSide;
  std::vector<std::pair<Index, Index>> links;
  for (Index i = 0; i < kRows; ++i) {
    if (i % kSide > 0) links.emplace_back(i - 1, i);
    if (i >= kSide) links.emplace_back(i - kSide, i);
  }
  Random random(3);
  LinearSystem system;
  system.matrix = BlockMatrix(kRows, links);
  for (Index i = 0; i < kRows; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 1);
  for (const auto& [i, j] : links) {
    const Vec3 n = (Vec3(j - i == 1, j - i != 1, 0) + 0.1 * random.vector()).normalized();
    const Mat3 spring = 1e5 * n * n.transpose() + Mat3::Identity();
    for (Index k : {i, j}) system.matrix.add(system.matrix.diagonal(k), spring);
    system.matrix.subtract(system.matrix.slot(i, j), spring);
    system.matrix.subtract(system.matrix.slot(j, i), spring);
  }
  const auto b = random.vectors(kRows);
  std::vector<std::vector<Vec3>> solutions;
  for (int threads : {1, 2, 3}) {
    set_thread_count(threads);
    ConjugateGradient cg;
    cg.prepare(system);
    std::vector<Vec3> x(kRows);
    const LinearReport report = cg.solve(b, {1e-6}, 1000, x);
    EXPECT_TRUE(report.converged);
    // The block diagonal alone needs more than 1,000.
    EXPECT_LT(report.iterations, 300);
    solutions.push_back(x);
  }
  set_thread_count(0);
  EXPECT_EQ(solutions[1], solutions[0]);
  EXPECT_EQ(solutions[2], solutions[0]);
}

}  // namespace
}  // namespace weft::solver
