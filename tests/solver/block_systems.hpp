// Random symmetric positive definite block systems, sparse for the solver and dense for comparison.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "physics/solver/conjugate_gradient.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::solver::testing {

/// Random numbers that are the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low = -1, double high = 1) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Index below(Index count) { return std::uniform_int_distribution<Index>(0, count - 1)(engine_); }
  Vec3 vector() { return {number(), number(), number()}; }
  /// Symmetric, with eigenvalues between `low` and `low` + 9.
  Mat3 definite(double low) {
    Mat3 a;
    a << vector(), vector(), vector();
    return a * a.transpose() + low * Mat3::Identity();
  }
  std::vector<Vec3> vectors(Index count) {
    std::vector<Vec3> x(static_cast<std::size_t>(count));
    for (Vec3& entry : x) entry = vector();
    return x;
  }

 private:
  std::mt19937 engine_;
};

/// Springs between random neighbours plus a positive definite diagonal.
inline BlockMatrix random_matrix(Index rows, Random& random) {
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 1; i < rows; ++i)
    for (int k = 0; k < 3; ++k) couplings.emplace_back(i, random.below(i));
  BlockMatrix matrix(rows, couplings);
  for (Index i = 0; i < rows; ++i) matrix.add(matrix.diagonal(i), random.definite(0.1));
  for (const auto& [i, j] : couplings) matrix.add_spring(i, j, 3 * random.definite(0));
  return matrix;
}

/// A system with contacts of two to four particles, and constraints of every kind: to a point, a line and a plane.
inline LinearSystem random_system(Index rows, int terms, Random& random) {
  LinearSystem system;
  system.matrix = random_matrix(rows, random);
  for (int t = 0; t < terms; ++t) {
    StencilTerm term;
    const int involved = 2 + t % 3;
    for (int k = 0; k < involved; ++k) {
      term.particles[k] = (random.below(rows / 4) * 4 + k) % rows;  // four different particles
      term.weights[k] = random.number();
    }
    const Vec3 n = random.vector().normalized();
    term.stiffness = 50 * n * n.transpose();
    system.terms.push_back(term);
  }
  for (Index i = 0; i < rows; i += 7) {
    const Vec3 n = random.vector().normalized();
    const Mat3 line = n * n.transpose();
    const Mat3 kinds[] = {Mat3::Zero(), line, Mat3::Identity() - line};
    system.constraints.push_back({i, kinds[(i / 7) % 3]});
  }
  return system;
}

/// All entries of the matrix, block by block through slot(); `pattern` lists the existing blocks.
inline Eigen::MatrixXd dense(const BlockMatrix& matrix, const std::vector<std::pair<Index, Index>>& pattern) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(3 * matrix.rows(), 3 * matrix.rows());
  for (const auto& [i, j] : pattern) full.block<3, 3>(3 * i, 3 * j) = matrix.block(matrix.slot(i, j));
  return full;
}

/// All entries of the matrix, column by column through multiply().
inline Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const auto rows = static_cast<std::size_t>(matrix.rows());
  Eigen::MatrixXd full(3 * matrix.rows(), 3 * matrix.rows());
  std::vector<Vec3> x(rows, Vec3::Zero()), y(rows);
  for (std::size_t i = 0; i < rows; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      x[i][axis] = 1;
      matrix.multiply<Vec3>(x, y, 0, rows);
      x[i][axis] = 0;
      for (std::size_t r = 0; r < rows; ++r)
        full.block<3, 1>(static_cast<Eigen::Index>(3 * r), static_cast<Eigen::Index>(3 * i) + axis) = y[r];
    }
  return full;
}

/// The components of all vectors in one column.
inline Eigen::Map<const Eigen::VectorXd> flat(std::span<const Vec3> x) {
  return {x.data()->data(), static_cast<Eigen::Index>(3 * x.size())};
}

/// The matrix plus all terms that the system stores beside it.
inline Eigen::MatrixXd dense_with_terms(const LinearSystem& system) {
  Eigen::MatrixXd a = dense(system.matrix);
  for (const DiagonalTerm& term : system.diagonal_terms)
    a.block<3, 3>(3 * term.particle, 3 * term.particle) += term.stiffness;
  for_each_term(system, [&](const auto& term) {
    for (std::size_t p = 0; p < term.particles.size(); ++p)
      for (std::size_t q = 0; q < term.particles.size(); ++q)
        a.block<3, 3>(3 * term.particles[p], 3 * term.particles[q]) +=
            term.weights[p] * term.weights[q] * term.stiffness;
  });
  for (const RankOneTerm& term : system.rank_one_terms) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(a.rows());
    d.segment(3 * term.begin, 3 * static_cast<Index>(term.direction.size())) = flat(term.direction);
    a += term.stiffness * d * d.transpose();
  }
  return a;
}

/// Block-diagonal projection onto the free directions.
inline Eigen::MatrixXd projection(const LinearSystem& system) {
  const Eigen::Index size = 3 * system.matrix.rows();
  Eigen::MatrixXd s = Eigen::MatrixXd::Identity(size, size);
  for (const ParticleConstraint& c : system.constraints) s.block<3, 3>(3 * c.particle, 3 * c.particle) = c.free;
  return s;
}

/// The solution on the free directions, by a direct method.
inline Eigen::VectorXd direct_solution(const LinearSystem& system, std::span<const Vec3> b) {
  const Eigen::MatrixXd s = projection(system), identity = Eigen::MatrixXd::Identity(s.rows(), s.cols());
  return Eigen::MatrixXd(s * dense_with_terms(system) * s + (identity - s)).ldlt().solve(s * flat(b));
}

/// The same system with the particles [begin, end) held.
inline LinearSystem with_held(LinearSystem system, Index begin, Index end) {
  std::erase_if(system.constraints, [&](const auto& c) { return c.particle >= begin && c.particle < end; });
  for (Index i = begin; i < end; ++i) system.constraints.push_back({i, Mat3::Zero()});
  return system;
}

/// Groups consecutive particles into aggregates, and aggregates into larger ones: one level for each count. If each
/// aggregate has one particle, constraints hold some aggregates.
inline void cut_groups(LinearSystem& system, const std::vector<Index>& counts) {
  system.aggregate_levels.clear();
  Index members = system.matrix.rows();
  for (Index count : counts) {
    Aggregates aggregates{{}, count};
    for (Index i = 0; i < members; ++i) aggregates.of.push_back(i * count / members);
    system.aggregate_levels.push_back(std::move(aggregates));
    members = count;
  }
}

/// Padded vectors, as the inner loops use them.
template <class Real = double>
std::vector<PaddedVec3<Real>> padded_vectors(std::span<const Vec3> x) {
  std::vector<PaddedVec3<Real>> result;
  for (const Vec3& v : x) result.push_back(padded<Real>(v));
  return result;
}
template <class Padded>
std::vector<Vec3> vectors(const std::vector<Padded>& x) {
  std::vector<Vec3> result;
  for (const Padded& q : x) result.push_back(vec3_of(q));
  return result;
}

/// Three blocks of twenty particles, coupled only by contacts.
inline LinearSystem system_of_parts(Random& random) {
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
  for (Index p = 0; p < 3; ++p) system.blocks.push_back({kPart * p, kPart * (p + 1)});
  return system;
}

struct Solved {
  std::vector<Vec3> x;
  LinearReport report;
};
/// A solve by a new solver.
inline Solved solved(const LinearSystem& system, std::span<const Vec3> b, const LinearGoal& goal,
                     int max_iterations = 1000, const Directions& directions = {}) {
  ConjugateGradient cg;
  cg.prepare(system);
  std::vector<Vec3> x(b.size());
  const LinearReport report = cg.solve(b, goal, max_iterations, x, directions);
  return {x, report};
}

/// √(bᵀ P⁻¹ b) with the preconditioner P, for the components of b in the free directions.
inline double norm(ConjugateGradient& cg, std::vector<Vec3> b) {
  cg.filter(b);
  const std::span<const Vec3> z = cg.precondition(b);
  double sum = 0;
  for (std::size_t i = 0; i < b.size(); ++i) sum += b[i].dot(z[i]);
  return std::sqrt(sum);
}

}  // namespace weft::solver::testing
