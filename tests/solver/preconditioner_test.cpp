// The preconditioner against the sum that its header states, made of dense matrices.
#include "solver/preconditioner.hpp"

#include <gtest/gtest.h>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::Random;

constexpr Index kRows = 40;

// Restriction to a level: sums over the groups of the particles of each.
Eigen::MatrixXd restriction(const std::vector<Index>& group_of, Index groups) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(3 * groups, 3 * static_cast<Eigen::Index>(group_of.size()));
  for (std::size_t i = 0; i < group_of.size(); ++i)
    r.block<3, 3>(3 * group_of[i], 3 * static_cast<Eigen::Index>(i)).setIdentity();
  return r;
}

Eigen::MatrixXd diagonal_blocks(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(a.rows(), a.cols());
  for (Eigen::Index i = 0; i < a.rows(); i += 3) blocks.block<3, 3>(i, i) = a.block<3, 3>(i, i);
  return blocks;
}

// Sum over the levels of R^T A_l^-1 R, A_l the Galerkin product R (S A S) R^T: its diagonal blocks, on the last level
// all of it; for single particles those of S A S + (I - S).
Eigen::MatrixXd dense_preconditioner(const LinearSystem& system) {
  const Eigen::MatrixXd s = testing::projection(system), identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
  const Eigen::MatrixXd a = s * testing::dense_with_terms(system) * s;
  Eigen::MatrixXd sum = diagonal_blocks(a + identity - s).inverse();
  std::vector<Index> group_of;
  for (Index i = 0; i < system.matrix.rows(); ++i) group_of.push_back(i);
  for (const Grouping& grouping : system.groupings) {
    for (Index& group : group_of) group = grouping.of[group];
    const Eigen::MatrixXd r = restriction(group_of, grouping.count), coarse = r * a * r.transpose();
    const bool last = &grouping == &system.groupings.back();
    sum += r.transpose() * (last ? coarse : diagonal_blocks(coarse)).inverse() * r;
  }
  return s * sum * s;
}

// Contacts of one to four particles as stiff as the springs, within groups and across them, and constraints. Each group
// has a particle that is free.
LinearSystem system_with_contacts(Random& random) {
  LinearSystem system = testing::random_system(kRows, 30, random);
  for (Index i = 2; i < kRows; i += 5) system.diagonal_terms.push_back({i, random.definite(20)});
  return system;
}

TEST(Preconditioner, IsTheSumOverLevelsOfGalerkinProductsWithContactsInAll) {
  for (const std::vector<Index>& counts : {std::vector<Index>{}, {6}, {20, 6}, {20, 10, 3}}) {
    Random random(41);
    LinearSystem system = system_with_contacts(random);
    testing::cut_groups(system, counts);
    Preconditioner preconditioner;
    preconditioner.prepare(system);
    const Eigen::MatrixXd expected = dense_preconditioner(system);
    std::vector<Vec3> r = random.vectors(kRows), z(kRows);
    preconditioner.filter(r);
    const std::size_t all[] = {0};
    const double product = preconditioner.apply(r, z, all);
    const Eigen::VectorXd wanted = expected * testing::flat(r);
    // The shift of 1e-13 of the trace, times the condition of the blocks, about 1e2.
    EXPECT_LT((testing::flat(z) - wanted).norm(), 1e-10 * wanted.norm()) << counts.size() << " levels";
    EXPECT_NEAR(product, testing::flat(r).dot(wanted), 1e-10 * product) << counts.size() << " levels";
  }
}

}  // namespace
}  // namespace weft::solver
