// Joins triangles with separately given corner positions into one mesh by least squares.
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <vector>

#include "physics/mesh/mesh.hpp"

namespace weft::garment {

/// Finds positions x of vertices in N dimensions [m]. Each triangle has given positions p of its corners; triangles
/// that share a vertex may have different positions for it. x minimises Σ ‖(x_i − x_j) − (p_i − p_j)‖² over the sides
/// of all triangles, plus anchor · Σ ‖x_i − p_i‖² over the corners of all triangles.
template <int N>
class LeastSquaresPositions {
 public:
  using Place = Eigen::Matrix<double, N, 1>;

  LeastSquaresPositions(std::size_t vertices, double anchor)
      : anchor_(anchor), right_(Right::Zero(static_cast<Eigen::Index>(vertices), N)) {}

  void add(const mesh::Triangle& triangle, const std::array<Place, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = triangle[k], j = triangle[(k + 1) % 3];
      const Place &p = corners[k], &q = corners[(k + 1) % 3];
      entries_.emplace_back(i, i, 1 + anchor_);
      entries_.emplace_back(j, j, 1);
      entries_.emplace_back(i, j, -1);
      entries_.emplace_back(j, i, -1);
      right_.row(i) += (p - q + anchor_ * p).transpose();
      right_.row(j) -= (p - q).transpose();
    }
  }

  std::vector<Place> solve() const {
    Eigen::SparseMatrix<double> matrix(right_.rows(), right_.rows());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Right x = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right_);
    std::vector<Place> places;
    for (Eigen::Index v = 0; v < x.rows(); ++v) places.push_back(x.row(v).transpose());
    return places;
  }

 private:
  using Right = Eigen::Matrix<double, Eigen::Dynamic, N>;
  double anchor_;
  std::vector<Eigen::Triplet<double>> entries_;
  Right right_;
};

}  // namespace weft::garment
