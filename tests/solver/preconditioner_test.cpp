// Compares the preconditioner with the sum stated in preconditioner.hpp, computed with dense matrices.
#include "physics/solver/preconditioner.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/block_systems.hpp"

namespace weft::solver {
namespace {

using testing::Random;

constexpr Index kSystemRows = 40;

// Restriction to a level: sums over the particles of each aggregate.
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

// Interpolation from aggregates to members: piecewise constants after one Jacobi step with damping 1/2. A member gets
// half of the value of its own aggregate, and half of the mean over the aggregates of its neighbours.
Eigen::MatrixXd interpolation(const Aggregates& aggregates, const Eigen::MatrixXd& neighbours) {
  const auto members = static_cast<Eigen::Index>(aggregates.of.size());
  Eigen::MatrixXd constants = Eigen::MatrixXd::Zero(members, aggregates.count), means = constants;
  for (Eigen::Index m = 0; m < members; ++m) constants(m, aggregates.of[m]) = 1;
  for (Eigen::Index m = 0; m < members; ++m)
    means.row(m) = neighbours.row(m).sum() > 0
                       ? Eigen::RowVectorXd(neighbours.row(m) * constants / neighbours.row(m).sum())
                       : Eigen::RowVectorXd(constants.row(m));
  return 0.5 * constants + 0.5 * means;
}

Eigen::MatrixXd threefold(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * a.rows(), 3 * a.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j) result.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(a(i, j));
  return result;
}

// For each particle, the stiffness of its terms if all particles with weights of the same sign move together.
Eigen::MatrixXd lumped_terms(const LinearSystem& system) {
  const Eigen::Index rows = system.matrix.rows();
  Eigen::MatrixXd lumped = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
  for (const DiagonalTerm& term : system.diagonal_terms)
    lumped.block<3, 3>(3 * term.particle, 3 * term.particle) += term.stiffness;
  for (const StencilTerm& term : system.terms)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (const double weight = term.weights[a] * term.weights[b]; weight > 0)
          lumped.block<3, 3>(3 * term.particles[a], 3 * term.particles[a]) += weight * term.stiffness;
  return lumped;
}

// The sum stated in preconditioner.hpp. On all levels but the last, A_l has diagonal blocks only.
Eigen::MatrixXd dense_preconditioner(const LinearSystem& system, bool stiff) {
  const Eigen::Index rows = system.matrix.rows();
  const Eigen::MatrixXd s = testing::projection(system), identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
  const Eigen::MatrixXd matrix = testing::dense(system.matrix), all = testing::dense_with_terms(system);
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(system.norm_weights.data(), rows);
  const Eigen::MatrixXd norm_weights = threefold(weights.asDiagonal()), held = identity - s;
  const Eigen::MatrixXd lasting = s * norm_weights * s + held * diagonal_blocks(matrix) * held;
  const Eigen::MatrixXd lumped = s * lumped_terms(system) * s;
  Eigen::MatrixXd sum = diagonal_blocks(s * all * s + held).inverse();

  Eigen::MatrixXd neighbours = Eigen::MatrixXd::Zero(rows, rows);
  system.matrix.for_each_block(0, rows, [&](Index i, Index j, const auto&) { neighbours(i, j) = i != j; });
  std::vector<Index> group_of(rows);
  std::iota(group_of.begin(), group_of.end(), 0);
  Eigen::MatrixXd from_groups = Eigen::MatrixXd::Identity(rows, rows);
  double coupling_factor = 1;
  for (const Aggregates& aggregates : system.aggregate_levels) {
    const Eigen::MatrixXd step =
        interpolation(aggregates, stiff ? Eigen::MatrixXd::Zero(neighbours.rows(), neighbours.cols()) : neighbours);
    from_groups *= step;
    for (Index& group : group_of) group = aggregates.of[group];
    if (!stiff) coupling_factor *= 0.5;
    const Eigen::MatrixXd r = restriction(group_of, aggregates.count);
    const Eigen::MatrixXd coarse = r * (coupling_factor * s * (matrix - norm_weights) * s + lasting) * r.transpose();
    const Eigen::MatrixXd p = threefold(from_groups);
    Eigen::MatrixXd block = coarse + p.transpose() * s * (all - matrix) * s * p;
    if (&aggregates != &system.aggregate_levels.back()) {
      block = diagonal_blocks(coarse);
      for (Eigen::Index g = 0; g < aggregates.count; ++g)
        for (Eigen::Index i = 0; i < rows; ++i)
          block.block<3, 3>(3 * g, 3 * g) += from_groups(i, g) * lumped.block<3, 3>(3 * i, 3 * i);
    }
    sum += p * block.inverse() * p.transpose();

    // Two aggregates are neighbours if a member of one is a neighbour of a member of the other.
    Eigen::MatrixXd next = Eigen::MatrixXd::Zero(aggregates.count, aggregates.count);
    for (Eigen::Index i = 0; i < neighbours.rows(); ++i)
      for (Eigen::Index j = 0; j < neighbours.cols(); ++j)
        if (neighbours(i, j) != 0 && aggregates.of[i] != aggregates.of[j]) next(aggregates.of[i], aggregates.of[j]) = 1;
    neighbours = next;
  }
  return s * sum * s;
}

// A system with constraints, and with contacts of one to four particles, as stiff as the springs, within aggregates and
// across them. With one particle per aggregate, constraints hold some aggregates.
LinearSystem system_with_contacts(Random& random) {
  LinearSystem system = testing::random_system(kSystemRows, 30, random);
  for (Index i = 0; i < kSystemRows; ++i) system.norm_weights.push_back(random.number(0.01, 0.1));
  for (Index i = 2; i < kSystemRows; i += 5) system.diagonal_terms.push_back({i, random.definite(20)});
  return system;
}

// Random vectors that obey the constraints.
std::vector<Vec3> free_vectors(const LinearSystem& system, Random& random) {
  std::vector<Vec3> r = random.vectors(kSystemRows);
  for (const ParticleConstraint& c : system.constraints) r[c.particle] = c.free * r[c.particle];
  return r;
}

template <class Real>
Eigen::VectorXd apply(Preconditioner<Real>& preconditioner, const std::vector<Vec3>& r, std::size_t blocks) {
  std::vector<std::size_t> all(blocks);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<PaddedVec3<Real>> z(r.size());
  preconditioner.apply(testing::padded_vectors<Real>(r), z, all);
  return testing::flat(testing::vectors(z));
}

template <class Real>
Eigen::VectorXd applied(const LinearSystem& system, const std::vector<Vec3>& r) {
  Preconditioner<Real> preconditioner;
  preconditioner.prepare(system);
  return apply(preconditioner, r, 1);
}

TEST(Preconditioner, IsTheSumOverLevelsWithContactsInAll) {
  for (const bool stiff : {false, true})
    for (const std::vector<Index>& counts : {std::vector<Index>{}, {6}, {20, 6}, {40, 20, 10, 3}}) {
      Random random(41);
      LinearSystem system = system_with_contacts(random);
      testing::cut_groups(system, counts);
      // With so little mass, all threads count as stiff (see `stiff_particle` in preconditioner.hpp).
      if (stiff)
        for (double& weight : system.norm_weights) weight *= 1e-6;
      const Eigen::MatrixXd expected = dense_preconditioner(system, stiff);
      const std::vector<Vec3> r = free_vectors(system, random);
      const Eigen::VectorXd wanted = expected * testing::flat(r);
      // Tolerance: the blocks are shifted by 1e-13 of their trace; their condition number is about 1e2.
      EXPECT_LT((applied<double>(system, r) - wanted).norm(), 1e-10 * wanted.norm()) << counts.size() << " levels";
      // Tolerance: single precision rounds by 6e-8, and entries may cancel: a factor of ten.
      EXPECT_LT((applied<float>(system, r) - wanted).norm(), 1e-6 * wanted.norm()) << counts.size() << " levels";
    }
}

// A cloth of many small pieces far from each other has many levels; most of these levels merge nothing.
TEST(Preconditioner, IsTheSumOverAsManyLevelsAsAClothCanHave) {
  Random random(53);
  LinearSystem system = system_with_contacts(random);
  std::vector<Index> counts(kMaxAggregateLevels - 1, 20);
  counts.push_back(6);
  testing::cut_groups(system, counts);
  const std::vector<Vec3> r = free_vectors(system, random);
  const Eigen::VectorXd wanted = dense_preconditioner(system, false) * testing::flat(r);
  // Tolerance: on coarse levels only mass is left beside contacts, so condition numbers are up to 1e4.
  EXPECT_LT((applied<double>(system, r) - wanted).norm(), 1e-7 * wanted.norm());
}

TEST(Preconditioner, InterpolatesWhereASingleParticleIsLight) {
  Random random(47);
  LinearSystem system = system_with_contacts(random);
  testing::cut_groups(system, {20, 6});
  // A single light particle, as in a finer region of a mesh, must not make aggregates move as wholes.
  system.norm_weights[7] *= 1e-6;
  const std::vector<Vec3> r = free_vectors(system, random);
  const Eigen::VectorXd wanted = dense_preconditioner(system, false) * testing::flat(r);
  // The same tolerance as in the first test.
  EXPECT_LT((applied<double>(system, r) - wanted).norm(), 1e-10 * wanted.norm());
}

// A block whose version and terms are unchanged keeps its set-up. Results equal those of a new set-up, to the bit.
TEST(Preconditioner, IsAsIfSetUpAnewWhateverWasKept) {
  Random random(43);
  LinearSystem system;
  BlockMatrix::Couplings links;
  for (Index i = 0; i < 60; ++i)
    for (Index j = 20 * (i / 20); j < i; ++j)
      if (random.below(5) == 0) links.emplace_back(i, j);
  system.matrix = BlockMatrix(60, links);
  for (Index i = 0; i < 60; ++i) system.matrix.add(system.matrix.diagonal(i), random.definite(20));
  for (Index p = 0; p < 3; ++p) system.blocks.push_back({20 * p, 20 * p + 20});
  testing::cut_groups(system, {30, 6, 3});
  const auto r = random.vectors(60);

  Preconditioner<float> kept;
  const auto check = [&](const char* what) {
    kept.prepare(system);
    Preconditioner<float> fresh;
    fresh.prepare(system);
    EXPECT_EQ(apply(kept, r, 3), apply(fresh, r, 3)) << what;
  };
  check("the first");
  system.diagonal_terms.push_back({25, random.definite(0)});
  system.terms.push_back({{5, 45, 46, 47}, {-1, 0.5, 0.25, 0.25}, random.definite(0)});
  check("terms have come");
  system.terms[0].stiffness *= 2;
  system.terms.push_back({{3, 22, 0, 0}, {-1, 1, 0, 0}, random.definite(0)});
  check("terms are others");
  system.terms.erase(system.terms.begin());
  system.diagonal_terms.clear();
  check("terms have gone");
  for (Index i = 20; i < 40; ++i) system.matrix.add_scalar(system.matrix.diagonal(i), 7);
  ++system.blocks[1].version;
  check("a part has changed");
  system.constraints.push_back({50, Mat3::Zero()});
  check("a particle is held");
  system.terms.clear();
  check("nothing is touched");
}

}  // namespace
}  // namespace weft::solver
