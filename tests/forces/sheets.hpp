// Small sheets, flat, curved and crumpled, and forces on them as dense vectors and matrices.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <random>
#include <vector>

#include "forces/bend.hpp"
#include "forces/force.hpp"
#include "forces/shear.hpp"
#include "forces/stretch.hpp"
#include "forces/triangle_bend.hpp"
#include "forces/triangle_membrane.hpp"
#include "mesh/mesh.hpp"

namespace weft::forces::testing {

using Positions = std::vector<Vec3>;

/// Five by four particles, 20 mm by 30 mm apart: nothing about it is the same along weft and warp.
inline const mesh::Grid kGrid{5, 4, 0.02, 0.03};

/// Particles at surface(u, v), u and v from 0 to the size of the sheet [m].
inline Positions shaped(const mesh::Grid& grid, const std::function<Vec3(double, double)>& surface) {
  Positions x;
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) x.push_back(surface(grid.u(i), grid.v(j)));
  return x;
}

inline Positions flat(const mesh::Grid& grid) {
  return shaped(grid, [](double u, double v) { return Vec3(u, v, 0); });
}

/// Vectors with entries from −size to size, the same on every run.
inline Positions random_vectors(std::size_t count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Positions vectors(count);
  for (Vec3& vector : vectors) vector = {number(engine), number(engine), number(engine)};
  return vectors;
}

/// Every particle off its place by up to `size` [m] along each axis.
inline Positions crumpled(const mesh::Grid& grid, double size, unsigned seed) {
  Positions x = flat(grid);
  const Positions noise = random_vectors(x.size(), size, seed);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
  return x;
}

/// Turned about an oblique axis and carried away.
inline Positions moved_rigidly(Positions x) {
  const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, -3).normalized());
  for (Vec3& point : x) point = turn * point + Vec3(0.7, -1.2, 2);
  return x;
}

/// Velocities of a body that turns and travels.
inline Positions rigid_velocities(const Positions& x) {
  Positions v;
  for (const Vec3& point : x) v.push_back(Vec3(3, -2, 1).cross(point) + Vec3(0.4, 0.1, -2));
  return v;
}

inline Positions zeros(const Positions& like) {
  return Positions(like.size(), Vec3::Zero());
}

inline Positions force_of(const Force& force, const Positions& x, const Positions& v, double rate = 0) {
  Positions f = zeros(x);
  force.add({.x = x, .v = v, .force = f, .rate = rate});
  return f;
}

/// −(∂f/∂x + rate ∂f/∂v) as the force puts it together, its constant part included.
inline Eigen::MatrixXd stiffness_of(Force& force, const Positions& x, const Positions& v, double rate,
                                    Linearisation linearisation) {
  std::vector<std::pair<Index, Index>> pairs;
  force.couple(pairs);
  const auto rows = static_cast<Index>(x.size());
  solver::BlockMatrix matrix(rows, pairs);
  force.attach(matrix);
  Positions f = zeros(x);
  force.add({x, v, f, &matrix, rate, linearisation});
  force.add_constant_stiffness(matrix);

  for (const auto& [i, j] : std::vector(pairs)) pairs.emplace_back(j, i);
  for (Index i = 0; i < rows; ++i) pairs.emplace_back(i, i);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
  for (const auto& [i, j] : pairs) dense.block<3, 3>(3 * i, 3 * j) = matrix.block(matrix.slot(i, j));
  return dense;
}

inline Eigen::Map<const Eigen::VectorXd> dense(const Positions& x) {
  return {x.data()->data(), static_cast<Eigen::Index>(3 * x.size())};
}

inline double largest(const Positions& x) {
  return dense(x).cwiseAbs().maxCoeff();
}

/// −(∂f/∂x + rate ∂f/∂v) by central differences at ε and half of it, put together so that the error of order ε²
/// cancels.
inline Eigen::MatrixXd stiffness_by_differences(const Force& force, const Positions& x, const Positions& v, double rate,
                                                double epsilon) {
  Eigen::MatrixXd jacobian(3 * x.size(), 3 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](double offset) {
        Positions moved_x = x, moved_v = v;
        moved_x[i][axis] += offset;
        moved_v[i][axis] += rate * offset;
        return force_of(force, moved_x, moved_v, rate);
      };
      const auto difference = [&](double e) {
        const Positions above = at(e), below = at(-e);
        return Eigen::VectorXd((dense(below) - dense(above)) / (2 * e));
      };
      jacobian.col(static_cast<Eigen::Index>(3 * i) + axis) = (4 * difference(epsilon / 2) - difference(epsilon)) / 3;
    }
  return jacobian;
}

}  // namespace weft::forces::testing
