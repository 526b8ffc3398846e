// V-cycles: symmetric block Gauss–Seidel on each level, dense Cholesky on the last.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bench/solver/block_rows.hpp"
#include "bench/solver/solvers.hpp"

namespace weft::bench {
namespace {

constexpr Index kMaxDenseBlocks = 100;   // maximum number of blocks on the last level
constexpr double kSingularShift = 1e-9;  // regularises motions that constraints forbid; relative to the mean diagonal

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

template <int N>
using Square = Eigen::Matrix<double, N, N>;
template <int N>
using Column = Eigen::Matrix<double, N, 1>;

/// A matrix, with one sweep over its rows in each direction.
template <int N>
struct Level {
  BlockRows<Square<N>> matrix;
  std::vector<Square<N>> inverse_diagonal;
  std::vector<Column<N>> residual, correction, left;

  void prepare() {
    const auto rows = at(matrix.rows());
    inverse_diagonal.resize(rows);
    residual.assign(rows, Column<N>::Zero());
    correction.assign(rows, Column<N>::Zero());
    left.assign(rows, Column<N>::Zero());
    double trace = 0;
    for (std::size_t i = 0; i < rows; ++i) trace += diagonal(i).trace();
    const double shift = kSingularShift * trace / (N * static_cast<double>(rows));
    for (std::size_t i = 0; i < rows; ++i) {
      if (N > 3) diagonal(i).diagonal().array() += shift;
      inverse_diagonal[i] = (diagonal(i) + shift * Square<N>::Identity()).inverse();
    }
  }
  Square<N>& diagonal(std::size_t i) {
    for (std::size_t s = matrix.start[i];; ++s)
      if (matrix.column[s] == static_cast<Index>(i)) return matrix.value[s];
  }

  // Computes x = (D + L)⁻¹ b and, in `of_b`, the residual b − A x, which is −U x.
  void sweep_down(std::span<const Column<N>> b, std::span<Column<N>> x, std::span<Column<N>> of_b) const {
    const Index rows = matrix.rows();
    for (Index i = 0; i < rows; ++i) {
      Column<N> sum = b[at(i)];
      for (std::size_t s = matrix.start[at(i)]; matrix.column[s] < i; ++s)
        sum.noalias() -= matrix.value[s] * x[at(matrix.column[s])];
      x[at(i)].noalias() = inverse_diagonal[at(i)] * sum;
    }
    for (Index i = 0; i < rows; ++i) {
      Column<N> sum = Column<N>::Zero();
      for (std::size_t s = matrix.start[at(i) + 1]; s-- > matrix.start[at(i)] && matrix.column[s] > i;)
        sum.noalias() -= matrix.value[s] * x[at(matrix.column[s])];
      of_b[at(i)] = sum;
    }
  }
  void sweep_up(std::span<const Column<N>> b, std::span<Column<N>> x) const {
    for (Index i = matrix.rows(); i-- > 0;) {
      Column<N> sum = b[at(i)];
      for (std::size_t s = matrix.start[at(i)]; s < matrix.start[at(i) + 1]; ++s)
        if (matrix.column[s] != i) sum.noalias() -= matrix.value[s] * x[at(matrix.column[s])];
      x[at(i)].noalias() = inverse_diagonal[at(i)] * sum;
    }
  }
};

// coarse = Pᵀ fine.
template <class Weight, class Fine, class Coarse>
void restrict_to(const BlockRows<Weight>& p, const std::vector<Fine>& fine, std::vector<Coarse>& coarse) {
  for (Coarse& entry : coarse) entry.setZero();
  for (std::size_t i = 0; i < fine.size(); ++i)
    for (std::size_t s = p.start[i]; s < p.start[i + 1]; ++s) {
      if constexpr (std::is_same_v<Weight, double>)
        coarse[at(p.column[s])] += p.value[s] * fine[i];
      else
        coarse[at(p.column[s])].noalias() += p.value[s].transpose() * fine[i];
    }
}

// fine += P coarse.
template <class Weight, class Fine, class Coarse>
void add_from(const BlockRows<Weight>& p, const std::vector<Coarse>& coarse, std::span<Fine> fine) {
  for (std::size_t i = 0; i < fine.size(); ++i)
    for (std::size_t s = p.start[i]; s < p.start[i + 1]; ++s) {
      if constexpr (std::is_same_v<Weight, double>)
        fine[i] += p.value[s] * coarse[at(p.column[s])];
      else
        fine[i].noalias() += p.value[s] * coarse[at(p.column[s])];
    }
}

/// Coarse levels have N functions per node. Interpolation weights are blocks W0 from the first coarse level to the
/// particles, and W between coarse levels.
template <int N, class W0, class W>
class Multigrid : public Inverse {
 public:
  void apply(std::span<const Vec3> r, std::span<Vec3> z) override {
    particles_.sweep_down(r, z, particles_.left);
    if (!coarse_.empty()) {
      restrict_to(to_particles_, particles_.left, coarse_[0].residual);
      cycle(0);
      add_from(to_particles_, coarse_[0].correction, z);
    }
    particles_.sweep_up(r, z);
    for (const auto& c : system_->constraints) z[at(c.particle)] = (c.free * z[at(c.particle)]).eval();
  }

 protected:
  void start(const SheetSystem& sheet) {
    system_ = &sheet.system;
    particles_.matrix = assembled(sheet.system);
    particles_.prepare();
    coarse_.clear();
    to_fine_.clear();
  }
  template <class P, int M>
  void add_level(const BlockRows<Square<M>>& fine, const P& p) {
    Level<N> level;
    level.matrix = product(transposed(p), product(fine, p));
    level.prepare();
    coarse_.push_back(std::move(level));
  }
  void finish() {
    const auto& last = coarse_.back().matrix;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(N * last.rows(), N * last.rows());
    for (Index i = 0; i < last.rows(); ++i)
      for (std::size_t s = last.start[at(i)]; s < last.start[at(i) + 1]; ++s)
        dense.template block<N, N>(N * i, N * last.column[s]) = last.value[s];
    dense.diagonal().array() += kSingularShift * dense.trace() / static_cast<double>(dense.rows());
    dense_.compute(dense);
  }

  void cycle(std::size_t l) {
    Level<N>& level = coarse_[l];
    if (l + 1 == coarse_.size()) {
      Eigen::Map<const Eigen::VectorXd> b(level.residual[0].data(), N * level.matrix.rows());
      Eigen::Map<Eigen::VectorXd> x(level.correction[0].data(), N * level.matrix.rows());
      x = dense_.solve(b);
      return;
    }
    level.sweep_down(level.residual, level.correction, level.left);
    restrict_to(to_fine_[l], level.left, coarse_[l + 1].residual);
    cycle(l + 1);
    add_from(to_fine_[l], coarse_[l + 1].correction, std::span<Column<N>>(level.correction));
    level.sweep_up(level.residual, level.correction);
  }

  const solver::LinearSystem* system_ = nullptr;
  Level<3> particles_;
  BlockRows<W0> to_particles_;  // from the first coarse level
  std::vector<Level<N>> coarse_;
  std::vector<BlockRows<W>> to_fine_;  // from level l + 1 to l
  Eigen::LLT<Eigen::MatrixXd> dense_;
};

// ---------------------------------------------------------------------------------------------------------------------

/// Geometric coarsening: a coarse grid has every second particle of each line, and the last one.
class Geometric final : public Multigrid<3, double, double> {
 public:
  void factorise(const SheetSystem& sheet) override {
    start(sheet);
    int side = sheet.side;
    to_particles_ = bilinear(side);
    side = side / 2 + 1;
    add_level(particles_.matrix, to_particles_);
    while (coarse_.back().matrix.rows() > kMaxDenseBlocks) {
      to_fine_.push_back(bilinear(side));
      side = side / 2 + 1;
      add_level(coarse_.back().matrix, to_fine_.back());
    }
    finish();
  }

 private:
  static BlockRows<double> bilinear(int side) {
    const int coarse = side / 2 + 1;
    // Particles with even numbers are also in the coarse grid; a particle with an odd number is between two of these.
    // If a side has an even number of particles, its last particle is also in the coarse grid.
    const auto line = [&](int i) -> std::vector<std::pair<int, double>> {
      if (i % 2 == 0) return {{i / 2, 1.0}};
      if (i == side - 1) return {{coarse - 1, 1.0}};
      return {{i / 2, 0.5}, {i / 2 + 1, 0.5}};
    };
    BlockRows<double> p;
    p.columns = coarse * coarse;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        for (const auto& [cj, wj] : line(j))
          for (const auto& [ci, wi] : line(i)) {
            p.column.push_back(ci + coarse * cj);
            p.value.push_back(wi * wj);
          }
        p.start.push_back(p.column.size());
      }
    return p;
  }
};

// ---------------------------------------------------------------------------------------------------------------------

/// Aggregates of 3 × 3 particles, then of 3 × 3 aggregates; P = (I − 4/(3 ρ) D⁻¹ A) P₀ (Vaněk, Mandel & Brezina,
/// "Algebraic Multigrid by Smoothed Aggregation for Second and Fourth Order Elliptic Problems", 1996). With N = 6, P₀
/// holds the rotations about the centre of each aggregate as well as the translations (for cloth: Tamstorf, Jones &
/// McCormick, 2015).
template <int N>
class Aggregation final : public Multigrid<N, Eigen::Matrix<double, 3, N>, Square<N>> {
 public:
  void factorise(const SheetSystem& sheet) override {
    this->start(sheet);
    int side = sheet.side;
    std::vector<Vec3> centres = sheet.x;
    this->to_particles_ = smoothed(this->particles_, tentative<3>(side, centres, &sheet.system));
    this->add_level(this->particles_.matrix, this->to_particles_);
    while (this->coarse_.back().matrix.rows() > kMaxDenseBlocks) {
      this->to_fine_.push_back(smoothed(this->coarse_.back(), tentative<N>(side, centres, nullptr)));
      this->add_level(this->coarse_.back().matrix, this->to_fine_.back());
    }
    this->finish();
  }

 private:
  // P₀: motions of particles, or of finer aggregates, for the rigid motions of aggregates. Replaces `side` and
  // `centres` by those of the aggregates.
  template <int M>
  static BlockRows<Eigen::Matrix<double, M, N>> tentative(int& side, std::vector<Vec3>& centres,
                                                          const solver::LinearSystem* system) {
    const int coarse = (side + 2) / 3;
    std::vector<Vec3> sums(static_cast<std::size_t>(coarse * coarse), Vec3::Zero());
    std::vector<double> counts(sums.size(), 0);
    BlockRows<Eigen::Matrix<double, M, N>> p;
    p.columns = coarse * coarse;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        p.column.push_back(i / 3 + coarse * (j / 3));
        p.start.push_back(p.column.size());
        sums[at(p.column.back())] += centres[at(i + side * j)];
        counts[at(p.column.back())] += 1;
      }
    for (std::size_t a = 0; a < sums.size(); ++a) sums[a] /= counts[a];
    for (std::size_t i = 0; i < p.column.size(); ++i) {
      Eigen::Matrix<double, M, N> block = Eigen::Matrix<double, M, N>::Zero();
      block.template topLeftCorner<3, 3>().setIdentity();
      if constexpr (N == 6) {
        const Vec3 d = centres[i] - sums[at(p.column[i])];
        Mat3 turn;  // ω × d
        turn << 0, d.z(), -d.y(), -d.z(), 0, d.x(), d.y(), -d.x(), 0;
        block.template topRightCorner<3, 3>() = turn;
        if constexpr (M == 6) block.template bottomRightCorner<3, 3>().setIdentity();
      }
      p.value.push_back(block);
    }
    if (system != nullptr)
      for (const auto& c : system->constraints)
        p.value[at(c.particle)].template topRows<3>() = (c.free * p.value[at(c.particle)].template topRows<3>()).eval();
    centres = std::move(sums);
    side = coarse;
    return p;
  }

  template <int M>
  static BlockRows<Eigen::Matrix<double, M, N>> smoothed(const Level<M>& level,
                                                         const BlockRows<Eigen::Matrix<double, M, N>>& tentative) {
    const double omega = 4.0 / 3 / spectral_radius(level);
    auto p = product(level.matrix, tentative);
    for (std::size_t i = 0; i < at(p.rows()); ++i)
      for (std::size_t s = p.start[i]; s < p.start[i + 1]; ++s) {
        p.value[s] = (-omega * (level.inverse_diagonal[i] * p.value[s])).eval();
        if (p.column[s] == tentative.column[i]) p.value[s] += tentative.value[i];
      }
    return p;
  }

  // Spectral radius of D⁻¹ A, by a few power iterations.
  template <int M>
  static double spectral_radius(const Level<M>& level) {
    const std::size_t rows = at(level.matrix.rows());
    std::vector<Column<M>> x(rows), y(rows);
    for (std::size_t i = 0; i < rows; ++i)
      for (int k = 0; k < M; ++k) x[i][k] = std::sin(static_cast<double>(1 + i * M + static_cast<std::size_t>(k) * 7));
    double radius = 1;
    for (int round = 0; round < 10; ++round) {
      double xx = 0, yy = 0;
      for (std::size_t i = 0; i < rows; ++i) {
        Column<M> sum = Column<M>::Zero();
        for (std::size_t s = level.matrix.start[i]; s < level.matrix.start[i + 1]; ++s)
          sum.noalias() += level.matrix.value[s] * x[at(level.matrix.column[s])];
        y[i] = level.inverse_diagonal[i] * sum;
        xx += x[i].squaredNorm();
        yy += y[i].squaredNorm();
      }
      radius = std::sqrt(yy / xx);
      for (std::size_t i = 0; i < rows; ++i) x[i] = y[i] / std::sqrt(yy);
    }
    return 1.1 * radius;
  }
};

}  // namespace

std::unique_ptr<Inverse> geometric_multigrid() {
  return std::make_unique<Geometric>();
}
std::unique_ptr<Inverse> aggregation_multigrid(int functions) {
  if (functions == 6) return std::make_unique<Aggregation<6>>();
  return std::make_unique<Aggregation<3>>();
}

}  // namespace weft::bench
