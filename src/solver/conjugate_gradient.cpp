#include "solver/conjugate_gradient.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// Rows per chunk: about 50 µs of work, well above what it costs to hand a chunk to another thread.
constexpr std::size_t kChunk = 1024;

}  // namespace

void ConjugateGradient::prepare(const LinearSystem& system) {
  system_ = &system;
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  inverse_diagonal_.resize(rows);
  for (auto* vector : {&r_, &z_, &p_, &q_}) vector->resize(rows);

  for (std::size_t i = 0; i < rows; ++i)
    inverse_diagonal_[i] = system.matrix.block(system.matrix.diagonal(static_cast<Index>(i)));
  for (const StencilTerm& term : system.terms)
    for (int a = 0; a < 4; ++a)
      inverse_diagonal_[static_cast<std::size_t>(term.particles[a])] +=
          term.weights[a] * term.weights[a] * term.stiffness;
  for (const ParticleConstraint& c : system.constraints) {
    Mat3& block = inverse_diagonal_[static_cast<std::size_t>(c.particle)];
    block = c.free * block * c.free + (Mat3::Identity() - c.free);
  }
  parallel_for(rows, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) inverse_diagonal_[i] = inverse_diagonal_[i].inverse().eval();
  });
  for (const ParticleConstraint& c : system.constraints) {
    Mat3& inverse = inverse_diagonal_[static_cast<std::size_t>(c.particle)];
    inverse = c.free * inverse * c.free;
  }
}

void ConjugateGradient::filter(std::span<Vec3> b) const {
  for (const ParticleConstraint& c : system_->constraints) {
    Vec3& entry = b[static_cast<std::size_t>(c.particle)];
    entry = c.free * entry;
  }
}

double ConjugateGradient::norm(std::span<const Vec3> b) const {
  return std::sqrt(parallel_sum(b.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += b[i].dot(inverse_diagonal_[i] * b[i]);
    return sum;
  }));
}

// q = S A p; returns p·q. p obeys the constraints, so p·q = pᵀ A p.
double ConjugateGradient::multiply(std::span<const Vec3> p, std::span<Vec3> q) const {
  parallel_for(p.size(), kChunk,
               [&](std::size_t begin, std::size_t end) { system_->matrix.multiply(p, q, begin, end); });
  for (const StencilTerm& term : system_->terms) {
    const auto& [a, b, c, d] = term.particles;
    const auto& w = term.weights;
    const Vec3 force = term.stiffness * (w[0] * p[static_cast<std::size_t>(a)] + w[1] * p[static_cast<std::size_t>(b)] +
                                         w[2] * p[static_cast<std::size_t>(c)] + w[3] * p[static_cast<std::size_t>(d)]);
    for (int k = 0; k < 4; ++k) q[static_cast<std::size_t>(term.particles[k])] += w[k] * force;
  }
  filter(q);
  return parallel_sum(p.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += p[i].dot(q[i]);
    return sum;
  });
}

// z = P⁻¹ r on the free directions; returns r·z.
double ConjugateGradient::precondition(std::span<const Vec3> r, std::span<Vec3> z) const {
  return parallel_sum(r.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      z[i] = inverse_diagonal_[i] * r[i];
      sum += r[i].dot(z[i]);
    }
    return sum;
  });
}

LinearReport ConjugateGradient::solve(std::span<const Vec3> b, double target, int max_iterations, std::span<Vec3> x) {
  LinearReport report;
  std::fill(x.begin(), x.end(), Vec3::Zero());
  std::copy(b.begin(), b.end(), r_.begin());
  filter(r_);
  double rz = precondition(r_, p_);
  report.first_residual = report.last_residual = std::sqrt(rz);

  while (!(report.last_residual <= target) && report.iterations < max_iterations) {
    const double curvature = multiply(p_, q_);
    if (!(curvature > 0)) {
      report.definite = false;
      return report;
    }
    const double alpha = rz / curvature;
    const double rz_next = parallel_sum(r_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) {
        x[i] += alpha * p_[i];
        r_[i] -= alpha * q_[i];
        z_[i] = inverse_diagonal_[i] * r_[i];
        sum += r_[i].dot(z_[i]);
      }
      return sum;
    });
    const double beta = rz_next / rz;
    parallel_for(p_.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p_[i] = z_[i] + beta * p_[i];
    });
    rz = rz_next;
    report.last_residual = std::sqrt(rz);
    ++report.iterations;
  }
  report.converged = report.last_residual <= target;
  return report;
}

}  // namespace weft::solver
