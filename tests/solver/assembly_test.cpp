// Tests of Assembly, which builds matrices from one block for each pair of particles.
#include "physics/solver/assembly.hpp"

#include <gtest/gtest.h>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

const BlockMatrix::Couplings kFull{{0, 1}, {4, 1}, {1, 2}, {6, 0}, {3, 5}}, kIsotropic{{0, 2}, {5, 1}, {4, 6}, {2, 6}};

Mat3 random_block(testing::Random& random) {
  Mat3 block;
  block << random.vector(), random.vector(), random.vector();
  return block;
}

void complete(const Assembly& assembly, BlockMatrix& matrix, const std::vector<Index>& bounds) {
  for (std::size_t k = 1; k < bounds.size(); ++k) assembly.complete_pairs(bounds[k - 1], bounds[k], matrix);
  for (std::size_t k = 1; k < bounds.size(); ++k) assembly.complete_rows(bounds[k - 1], bounds[k], matrix);
}

TEST(Assembly, WritesTheMatrixWhoseRowsAddUpToWhatTheyHaveOfTheirOwn) {
  constexpr Index kRows = 7;
  testing::Random random(3);
  BlockMatrix matrix(kRows, kFull, kIsotropic);
  Assembly assembly(matrix);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * kRows, 3 * kRows);
  const auto expect = [&](Index i, Index j, const Mat3& block) {
    expected.block<3, 3>(3 * i, 3 * j) += block;
    expected.block<3, 3>(3 * j, 3 * i) += block.transpose();
    expected.block<3, 3>(3 * i, 3 * i) -= block;
    expected.block<3, 3>(3 * j, 3 * j) -= block.transpose();
  };
  for (auto [i, j] : kIsotropic) {
    const double constant = random.vector().x();
    assembly.add_scalar(assembly.scalar(i, j), constant);
    expect(i, j, constant * Mat3::Identity());
  }
  for (Index i = 0; i < kRows; ++i) {
    assembly.add_constant_to_own(i, 0.5 + i);
    expected.block<3, 3>(3 * i, 3 * i) += (0.5 + i) * Mat3::Identity();
  }
  assembly.keep_constant();
  // Rows are assembled twice. start() clears the blocks of the first time, but keeps the constant part.
  for (int time = 0; time < 2; ++time) {
    assembly.start(0, 4, matrix);
    assembly.start(4, kRows, matrix);
    const AssemblyRows rows(assembly, matrix);
    for (auto [i, j] : kFull) {
      if (i > j) std::swap(i, j);
      const Mat3 block = random_block(random);
      const double scalar = random.vector().x();
      rows.add(rows.block(i, j), block);
      rows.add_scalar(assembly.scalar(j, i), scalar);
      if (time == 1) expect(i, j, block + scalar * Mat3::Identity());
    }
    const Vec3 n = random.vector();
    rows.add_to_own_block(3, packed_outer(n, n));
    if (time == 1) expected.block<3, 3>(9, 9) += n * n.transpose();
    complete(assembly, matrix, {0, 2, kRows});
  }
  Eigen::MatrixXd written = Eigen::MatrixXd::Zero(3 * kRows, 3 * kRows);
  matrix.for_each_block(0, kRows,
                        [&](Index i, Index j, const auto& block) { written.block<3, 3>(3 * i, 3 * j) = block; });
  // Tolerance: rounding, because the summands of a row are added in another order. (Measured: 1e-15.)
  EXPECT_LT((written - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Assembly, StartsNoOtherRows) {
  BlockMatrix matrix(4, {{0, 1}, {2, 3}});
  Assembly assembly(matrix);
  const AssemblyRows rows(assembly, matrix);
  rows.add(rows.block(0, 1), Mat3(-Mat3::Identity()));
  rows.add(rows.block(2, 3), Mat3(-2 * Mat3::Identity()));
  assembly.start(0, 2, matrix);
  complete(assembly, matrix, {0, 4});
  EXPECT_TRUE(matrix.block(matrix.diagonal(1)).isZero(0));
  EXPECT_EQ(matrix.block(matrix.diagonal(2)), Mat3(2 * Mat3::Identity()));
  assembly.start(0, 4, matrix);
  complete(assembly, matrix, {0, 4});
  EXPECT_TRUE(matrix.block(matrix.slot(3, 2)).isZero(0));
}

}  // namespace
}  // namespace weft::solver
