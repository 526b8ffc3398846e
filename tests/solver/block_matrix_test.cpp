// Compares the block matrix with a dense one.
#include "physics/solver/block_matrix.hpp"

#include <gtest/gtest.h>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::Random;

TEST(BlockMatrix, PatternIsTheDiagonalAndBothSidesOfEachCouplingOnce) {
  const BlockMatrix matrix(4, {{0, 2}, {2, 0}, {3, 1}, {3, 1}, {1, 1}});
  EXPECT_EQ(matrix.rows(), 4);
  EXPECT_EQ(matrix.blocks(), 4u + 2 + 2);
  // Slots go row by row, columns ascending.
  EXPECT_EQ(matrix.slot(0, 0), 0);
  EXPECT_EQ(matrix.slot(0, 2), 1);
  EXPECT_EQ(matrix.slot(1, 1), 2);
  EXPECT_EQ(matrix.slot(1, 3), 3);
  EXPECT_EQ(matrix.slot(2, 0), 4);
  EXPECT_EQ(matrix.slot(3, 1), 6);
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(matrix.diagonal(i), matrix.slot(i, i));
}

TEST(BlockMatrix, ProductIsThatOfTheDenseMatrix) {
  Random random(1);
  constexpr Index kRows = 23;
  std::vector<std::pair<Index, Index>> pattern, couplings;
  for (Index i = 0; i < kRows; ++i) pattern.emplace_back(i, i);
  for (Index i = 2; i < kRows; ++i) couplings.emplace_back(i, i % 2 ? 0 : i - 2);
  for (const auto& [i, j] : couplings) pattern.insert(pattern.end(), {{i, j}, {j, i}});

  BlockMatrix matrix(kRows, couplings);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * kRows, 3 * kRows);
  for (const auto& [i, j] : pattern) {
    Mat3 block;  // not symmetric, so that the test detects a transposed block
    block << random.vector(), random.vector(), random.vector();
    matrix.add(matrix.slot(i, j), block);
    expected.block<3, 3>(3 * i, 3 * j) = block;
  }
  EXPECT_EQ(testing::dense(matrix, pattern), expected);

  const auto x = random.vectors(kRows);
  std::vector<Vec3> y(kRows, Vec3::Constant(99));
  matrix.multiply<Vec3>(x, y, 0, kRows);
  // Tolerance: in a sum of up to 40 products of numbers below 1, each of 40 rounding errors is at most 40 · 1.1e-16.
  EXPECT_LT((testing::flat(y) - expected * testing::flat(x)).cwiseAbs().maxCoeff(), 2e-13);

  // Multiplying in pieces gives the same bits and writes nothing outside the piece.
  std::vector<Vec3> pieces(kRows, Vec3::Constant(99));
  matrix.multiply<Vec3>(x, pieces, 0, 5);
  EXPECT_EQ(pieces[5], Vec3(Vec3::Constant(99)));
  matrix.multiply<Vec3>(x, pieces, 5, kRows);
  EXPECT_EQ(pieces, y);
}

TEST(BlockMatrix, WithIsotropicBlocksIsTheDenseMatrix) {
  Random random(4);
  constexpr Index kRows = 9;
  const BlockMatrix::Couplings full{{0, 3}, {4, 1}, {7, 8}, {2, 5}};
  // One of these pairs is a full block as well, and stays one.
  const BlockMatrix::Couplings isotropic{{0, 2}, {3, 0}, {6, 1}, {8, 0}, {4, 5}, {2, 0}};
  BlockMatrix matrix(kRows, full, isotropic);
  EXPECT_EQ(matrix.blocks(), 9u + 2 * 4 + 2 * 4);
  EXPECT_GE(matrix.slot(0, 3), 0);
  EXPECT_LT(matrix.slot(0, 2), 0);

  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * kRows, 3 * kRows);
  const auto add = [&](Index i, Index j, const Mat3& block) { expected.block<3, 3>(3 * i, 3 * j) += block; };
  for (Index i = 0; i < kRows; ++i) {
    matrix.add_scalar(matrix.slot(i, i), 2.0 + static_cast<double>(i));
    add(i, i, (2.0 + static_cast<double>(i)) * Mat3::Identity());
  }
  for (const auto& [a, b] : full)
    for (const auto& [i, j] : {std::pair(a, b), std::pair(b, a)}) {
      Mat3 block;
      block << random.vector(), random.vector(), random.vector();
      matrix.add(matrix.slot(i, j), block);
      add(i, j, block);
    }
  for (const auto& [i, j] : isotropic) {
    const double value = random.vector().x();
    matrix.add_scalar(matrix.slot(i, j), value);
    add(i, j, value * Mat3::Identity());
  }

  // Reads the matrix row by row, columns ascending.
  Eigen::MatrixXd read = Eigen::MatrixXd::Zero(3 * kRows, 3 * kRows);
  std::pair<Index, Index> before(-1, -1);
  matrix.for_each_block(0, kRows, [&](Index i, Index j, const auto& block) {
    EXPECT_LT(before, std::pair(i, j));
    before = {i, j};
    read.block<3, 3>(3 * i, 3 * j) += block;
  });
  EXPECT_EQ(read, expected);
  const auto x = random.vectors(kRows);
  std::vector<Vec3> y(kRows), pieces(kRows);
  matrix.multiply<Vec3>(x, y, 0, kRows);
  // The same tolerance as in the test of the product above.
  EXPECT_LT((testing::flat(y) - expected * testing::flat(x)).cwiseAbs().maxCoeff(), 2e-13);
  matrix.multiply<Vec3>(x, pieces, 0, 5);
  matrix.multiply<Vec3>(x, pieces, 5, kRows);
  EXPECT_EQ(pieces, y);
}

TEST(BlockMatrix, AddsSpringsAndScalars) {
  BlockMatrix matrix(2, {{0, 1}});
  Mat3 block;
  block << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  matrix.add_spring(0, 1, block);
  matrix.add_scalar(matrix.slot(0, 1), 0.5);
  EXPECT_EQ(matrix.block(matrix.slot(0, 1)), Mat3(-block + 0.5 * Mat3::Identity()));
  EXPECT_EQ(matrix.block(matrix.slot(1, 0)), Mat3(-block));
  for (Index i : {0, 1}) EXPECT_EQ(matrix.block(matrix.diagonal(i)), block);
}

}  // namespace
}  // namespace weft::solver
