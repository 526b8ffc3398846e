// Contact terms on the coarsest level of the preconditioner.
#pragma once

#include <Eigen/Core>
#include <span>

#include "solver/linear_system.hpp"
#include "solver/weights.hpp"

namespace weft::solver {

/// Adds Tᵀ A T of all terms A of the system to the lower triangle of `matrix`, three rows for each coarsest aggregate.
/// `weights`: T, the interpolation of particles from the coarsest aggregates. `constraint_of`: number of each
/// particle's constraint, −1 for none. The sums have the order of the terms, on any number of threads.
template <class Real>
void add_terms(const LinearSystem& system, const Weights<Real>& weights, std::span<const Index> constraint_of,
               Eigen::MatrixXd& matrix);

}  // namespace weft::solver
