// Tests of wide terms, which connect a soft block with stiff bodies of four particles.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::Random;

constexpr Index kRows = 60;  // of the soft block; the rows of two bodies follow

// A soft block and two bodies of four particles, with springs of 1e4 N/m between the particles of each body. Each wide
// term connects a particle of the soft block with a body.
LinearSystem system_with_bodies(Random& random) {
  const BlockMatrix soft = testing::random_matrix(kRows, random);
  std::vector<std::pair<Index, Index>> pairs;
  soft.for_each_block(0, kRows, [&](Index i, Index j, const Mat3&) {
    if (i > j) pairs.emplace_back(i, j);
  });
  for (const Index first : {kRows, kRows + 4})
    for (Index i = 1; i < 4; ++i)
      for (Index j = 0; j < i; ++j) pairs.emplace_back(first + i, first + j);
  LinearSystem system;
  system.matrix = BlockMatrix(kRows + 8, pairs);
  soft.for_each_block(0, kRows,
                      [&](Index i, Index j, const Mat3& block) { system.matrix.add(system.matrix.slot(i, j), block); });
  for (const Index first : {kRows, kRows + 4})
    for (Index i = first; i < first + 4; ++i) {
      system.matrix.add(system.matrix.diagonal(i), Mat3(Mat3::Identity()));
      for (Index j = first; j < i; ++j) {
        const Vec3 n = random.vector().normalized();
        system.matrix.add_spring(i, j, 1e4 * n * n.transpose());
      }
    }
  system.norm_weights.assign(kRows + 8, 0.1);
  system.blocks = {{.begin = 0, .end = kRows},
                   {.begin = kRows, .end = kRows + 4, .is_small = true},
                   {.begin = kRows + 4, .end = kRows + 8, .is_small = true}};
  for (int contact = 0; contact < 6; ++contact) {
    WideTerm& term = system.wide_terms.emplace_back();
    for (Index k = 0; k < 4; ++k) {
      term.particles[static_cast<std::size_t>(k)] = kRows + 4 * (contact % 2) + k;
      term.weights[static_cast<std::size_t>(k)] = -0.25 + 0.3 * random.number();
    }
    term.particles[4] = random.below(kRows), term.weights[4] = 1;
    const Vec3 n = random.vector().normalized();
    term.stiffness = 100 * n * n.transpose();
  }
  Index members = kRows;
  for (const Index count : {20, 6}) {
    Aggregates& aggregates = system.aggregate_levels.emplace_back();
    for (Index i = 0; i < members; ++i) aggregates.of.push_back(i * count / members);
    for (Index body = 0; body < 8; ++body) aggregates.of.push_back(count + body);
    aggregates.count = count + 8;
    members = count;
  }
  return system;
}

TEST(WideTerms, AreSolvedWithStiffBodies) {
  Random random(77);
  const LinearSystem system = system_with_bodies(random);
  const auto b = random.vectors(system.matrix.rows());
  const Eigen::MatrixXd a = testing::dense_with_terms(system);
  const Eigen::VectorXd expected = a.ldlt().solve(testing::flat(b));
  const auto energy = [&](const Eigen::VectorXd& e) { return std::sqrt(e.dot(a * e)); };
  ConjugateGradient cg;
  cg.prepare(system);
  std::vector<Vec3> x(b.size());
  const LinearReport report = cg.solve(b, {1e-6}, 1000, x);
  EXPECT_TRUE(report.definite);
  EXPECT_LT(energy(testing::flat(x) - expected), 1e-5 * energy(expected));
  // Without wide terms, the coarsest level solves the bodies exactly, and only a few distinct eigenvalues remain.
  LinearSystem bodies = system;
  std::erase_if(bodies.wide_terms, [](const WideTerm&) { return true; });
  std::vector<Vec3> of_bodies(b.size(), Vec3::Zero()), y(b.size());
  for (std::size_t i = kRows; i < b.size(); ++i) of_bodies[i] = b[i];
  cg.prepare(bodies);
  EXPECT_LT(cg.solve(of_bodies, {1e-3}, 1000, y).iterations, 16);
}

}  // namespace
}  // namespace weft::solver
