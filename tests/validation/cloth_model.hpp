// The cloth of a scene as forces and masses only: equilibrium by Newton's method with the exact Jacobian, stability by
// the inertia of the Jacobian, and free vibrations. A run can show neither an unstable equilibrium nor a spectrum.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "film/environment/environment.hpp"
#include "physics/forces/bend.hpp"
#include "physics/forces/shear.hpp"
#include "physics/forces/stretch.hpp"
#include "physics/forces/triangle_bend.hpp"
#include "physics/forces/triangle_membrane.hpp"
#include "physics/simulation/pins.hpp"

namespace weft::simulation::testing {

/// The first cloth of a scene, without damping.
class ClothModel {
 public:
  explicit ClothModel(const scene::Scene& scene)
      : gravity_(scene.physics.gravity), model_(environment::Environment(scene).model), x(model_.cloths[0].start) {
    const scene::Material& m = scene.cloths[0].material;
    const model::Cloth& cloth = model_.cloths[0];
    const forces::StretchParameters stretch{m.stretch_weft, m.stretch_warp, 0};
    held_.resize(x.size());
    for (const auto& pin : cloth.pins)
      for (const model::WeightedParticle& chosen : pin.particles) held_[chosen.particle] = 1;
    if (cloth.sheet.triangles.empty()) {
      masses = forces::lumped_masses(cloth.grid, m.density);
      forces_.push_back(std::make_unique<forces::Stretch>(cloth.grid, 0, stretch));
      forces_.push_back(std::make_unique<forces::Shear>(cloth.grid, 0, forces::ShearParameters{m.shear, 0}));
      forces_.push_back(std::make_unique<forces::Bend>(cloth.grid, 0, forces::BendParameters{m.bend, 0, 0}));
    } else {
      masses = forces::lumped_masses(cloth.sheet, m.density);
      forces_.push_back(
          std::make_unique<forces::TriangleMembrane>(cloth.sheet, 0, stretch, forces::ShearParameters{m.shear, 0}));
      forces_.push_back(
          std::make_unique<forces::TriangleBend>(cloth.sheet, 0, forces::BendParameters{m.bend, 0, 0}, held_));
    }
    std::vector<std::pair<Index, Index>> pairs;
    for (const auto& force : forces_) force->append_couplings(pairs);
    matrix_ = solver::BlockMatrix(static_cast<Index>(x.size()), pairs);
    for (const auto& force : forces_) force->set_held(held_);
  }

  /// Indices 3 i + axis of the coordinates of unpinned particles along these axes.
  std::vector<Eigen::Index> free_along(const std::vector<int>& axes) const {
    std::vector<Eigen::Index> dofs;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int axis : axes)
        if (!held_[i]) dofs.push_back(3 * static_cast<Eigen::Index>(i) + axis);
    return dofs;
  }

  /// Exact −∂f/∂x for these coordinates.
  Eigen::SparseMatrix<double> stiffness(const std::vector<Eigen::Index>& dofs) {
    std::ranges::fill(matrix_.values(), 0.0);
    const std::vector<Vec3> zero(x.size(), Vec3::Zero());
    for (const auto& force : forces_) force->add_jacobian(x, zero, 0, matrix_);
    std::vector<Eigen::Index> row(3 * x.size(), -1);
    for (std::size_t k = 0; k < dofs.size(); ++k) row[dofs[k]] = static_cast<Eigen::Index>(k);
    std::vector<Eigen::Triplet<double>> entries;
    matrix_.for_each_block(0, matrix_.rows(), [&](Index i, Index j, const auto& block) {
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const auto r = row[3 * i + a], c = row[3 * j + b];
          if (r >= 0 && c >= 0) entries.emplace_back(r, c, block(a, b));
        }
    });
    const auto n = static_cast<Eigen::Index>(dofs.size());
    Eigen::SparseMatrix<double> stiffness(n, n);
    stiffness.setFromTriplets(entries.begin(), entries.end());
    return stiffness;
  }

  /// Whether every small displacement along these coordinates needs energy, by Sylvester's law of inertia.
  bool stable(const std::vector<Eigen::Index>& dofs) {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(stiffness(dofs));
    return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0;
  }

  /// Moves these coordinates to equilibrium under gravity: Newton's method with the exact Jacobian, shifted if that is
  /// indefinite; each step is shortened until the energy falls.
  void find_rest(const std::vector<Eigen::Index>& dofs) {
    const double weight = std::accumulate(masses.begin(), masses.end(), 0.0) * gravity_.norm();
    double shift = 0;
    for (int iteration = 0; iteration < 500; ++iteration) {
      const Eigen::VectorXd f = force(dofs);
      if (f.norm() < 1e-6 * weight) return;
      Eigen::SparseMatrix<double> k = stiffness(dofs);
      const double least_shift = 1e-6 * k.diagonal().maxCoeff();
      for (Eigen::Index d = 0; d < k.rows(); ++d) k.coeffRef(d, d) += shift;
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(k);
      while (factors.vectorD().minCoeff() <= 0) {
        const double more = std::max(2 * shift, least_shift) - shift;
        for (Eigen::Index d = 0; d < k.rows(); ++d) k.coeffRef(d, d) += more;
        shift += more;
        factors.compute(k);
      }
      const Eigen::VectorXd step = factors.solve(f);
      const std::vector<Vec3> start = x;
      const double before = energy(), slope = f.dot(step);
      double step_fraction = 1;
      for (;; step_fraction *= 0.5) {
        for (std::size_t d = 0; d < dofs.size(); ++d)
          coordinate(x, dofs[d]) = coordinate(start, dofs[d]) + step_fraction * step[static_cast<Eigen::Index>(d)];
        // Near equilibrium, rounding errors exceed the change of energy; the full step is right.
        if (slope < 1e-12 * std::abs(before) || energy() < before - 1e-4 * step_fraction * slope ||
            step_fraction < 1e-6)
          break;
      }
      shift = step_fraction == 1 ? 0.1 * shift : shift;
      if (shift < least_shift) shift = 0;
    }
    ADD_FAILURE() << "no rest: a force of " << force(dofs).norm() << " N is left of a weight of " << weight << " N";
  }

  struct Mode {
    double frequency;      ///< ω [rad/s]
    double mass_fraction;  ///< fraction of the mass that a uniform push would set in motion in this mode [1]
  };

  /// The vibrations of lowest frequency, in ascending order: K φ = ω² M φ by subspace iteration (Bathe, "Finite Element
  /// Procedures", 1996, 11.6).
  std::vector<Mode> modes(const std::vector<Eigen::Index>& dofs, int count) {
    const Eigen::SparseMatrix<double> k = stiffness(dofs);
    const auto n = static_cast<Eigen::Index>(dofs.size());
    Eigen::VectorXd m(n);
    for (Eigen::Index d = 0; d < n; ++d) m[d] = masses[dofs[d] / 3];
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(k);
    const Eigen::Index size = std::min<Eigen::Index>(n, 2 * count + 4);
    Eigen::MatrixXd basis(n, size);
    for (Eigen::Index c = 0; c < size; ++c)
      for (Eigen::Index d = 0; d < n; ++d) basis(d, c) = std::cos(0.7 * double(c + 1) * double(d) + double(c));
    Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
    for (int iteration = 0; iteration < 200; ++iteration) {
      const Eigen::MatrixXd load = m.asDiagonal() * basis;
      basis = factors.solve(load);
      const Eigen::MatrixXd small_k = basis.transpose() * load, small_m = basis.transpose() * m.asDiagonal() * basis;
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(small_k, small_m);
      basis = basis * ritz.eigenvectors();
      const double change =
          ((ritz.eigenvalues() - values).array() / ritz.eigenvalues().array()).head(count).abs().maxCoeff();
      values = ritz.eigenvalues();
      if (change < 1e-10) break;
    }
    std::vector<Mode> found;
    for (int c = 0; c < count; ++c) {
      const double norm_sq = basis.col(c).dot(m.asDiagonal() * basis.col(c));
      found.push_back({std::sqrt(values[c]), std::pow(m.dot(basis.col(c)), 2) / (norm_sq * m.sum())});
    }
    return found;
  }

  const model::Cloth& cloth() const { return model_.cloths[0]; }

 private:
  static double coordinate(const std::vector<Vec3>& x, Eigen::Index dof) { return x[dof / 3][dof % 3]; }
  static double& coordinate(std::vector<Vec3>& x, Eigen::Index dof) { return x[dof / 3][dof % 3]; }
  double energy() const {
    double sum = 0;
    for (const auto& force : forces_) sum += force->energy(x);
    for (std::size_t i = 0; i < x.size(); ++i) sum -= masses[i] * gravity_.dot(x[i]);
    return sum;
  }
  Eigen::VectorXd force(const std::vector<Eigen::Index>& dofs) const {
    std::vector<solver::PaddedVec3<double>> places, still(x.size()), sum(x.size());
    for (const Vec3& place : x) places.push_back(solver::padded<double>(place));
    for (const auto& force : forces_) force->add({places, still, sum});
    std::vector<Vec3> f(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) f[i] = masses[i] * gravity_ + solver::vec3_of(sum[i]);
    Eigen::VectorXd of(static_cast<Eigen::Index>(dofs.size()));
    for (std::size_t d = 0; d < dofs.size(); ++d) of[static_cast<Eigen::Index>(d)] = coordinate(f, dofs[d]);
    return of;
  }

  Vec3 gravity_;
  model::Model model_;
  std::vector<std::unique_ptr<forces::Force>> forces_;
  solver::BlockMatrix matrix_;
  std::vector<char> held_;

 public:
  std::vector<Vec3> x;         ///< positions [m]; initially those of the scene
  std::vector<double> masses;  ///< [kg]
};

}  // namespace weft::simulation::testing
