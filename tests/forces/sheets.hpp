// Small sheets (flat, curved and crumpled) and forces on them as dense vectors and matrices.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <random>
#include <vector>

#include "physics/forces/bend.hpp"
#include "physics/forces/force.hpp"
#include "physics/forces/shear.hpp"
#include "physics/forces/stretch.hpp"
#include "physics/forces/triangle_bend.hpp"
#include "physics/forces/triangle_membrane.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::forces::testing {

using Positions = std::vector<Vec3>;

/// Five by four particles, 20 mm by 30 mm apart. Counts and spacings differ, so that tests notice swapped axes.
inline const mesh::Grid kGrid{5, 4, 0.02, 0.03};
inline const double kWidth = (kGrid.nu - 1) * kGrid.lu, kHeight = (kGrid.nv - 1) * kGrid.lv;  ///< size of kGrid [m]

inline constexpr double kStiffness = 1000;  ///< of stretch [N/m]
inline constexpr double kRigidity = 3e-4;   ///< [N·m]

/// Particles at surface(u, v); u and v run from 0 to the size of the sheet [m].
inline Positions shaped(const mesh::Grid& grid, const std::function<Vec3(double, double)>& surface) {
  Positions x;
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) x.push_back(surface(grid.u(i), grid.v(j)));
  return x;
}

inline Positions flat(const mesh::Grid& grid) {
  return shaped(grid, [](double u, double v) { return Vec3(u, v, 0); });
}

/// Vectors with entries from −size to size, the same in every run.
inline Positions random_vectors(std::size_t count, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Positions vectors(count);
  for (Vec3& vector : vectors) vector = {number(engine), number(engine), number(engine)};
  return vectors;
}

/// Moves every particle by up to `size` [m] along each axis.
inline Positions shaken(Positions x, double size, unsigned seed) {
  const Positions noise = random_vectors(x.size(), size, seed);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += noise[i];
  return x;
}
inline Positions crumpled(const mesh::Grid& grid, double size, unsigned seed) {
  return shaken(flat(grid), size, seed);
}

/// Rotates about an oblique axis and translates.
inline Positions moved_rigidly(Positions x) {
  const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, -3).normalized());
  for (Vec3& point : x) point = turn * point + Vec3(0.7, -1.2, 2);
  return x;
}

/// Velocities of a body that rotates and translates.
inline Positions rigid_velocities(const Positions& x) {
  Positions v;
  for (const Vec3& point : x) v.push_back(Vec3(3, -2, 1).cross(point) + Vec3(0.4, 0.1, -2));
  return v;
}

inline Positions zeros(const Positions& like) {
  return Positions(like.size(), Vec3::Zero());
}

/// Positions and velocities at which a force is evaluated, and the resulting forces.
struct Place {
  std::vector<solver::PaddedVec3<double>> x, v, force;

  Place(const Positions& positions, const Positions& velocities) : force(positions.size()) {
    for (const Vec3& point : positions) x.push_back(solver::padded<double>(point));
    for (const Vec3& velocity : velocities) v.push_back(solver::padded<double>(velocity));
  }
  Evaluation evaluation(double rate = 0) {
    Evaluation at{x, v, force};
    at.rate = rate;
    return at;
  }
  Positions forces() const {
    Positions f;
    for (const auto& of_particle : force) f.push_back(solver::vec3_of(of_particle));
    return f;
  }
};

inline Positions force_of(const Force& force, const Positions& x, const Positions& v, double rate = 0) {
  Place place(x, v);
  force.add(place.evaluation(rate));
  return place.forces();
}

inline Eigen::MatrixXd dense(const solver::BlockMatrix& matrix) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * matrix.rows(), 3 * matrix.rows());
  matrix.for_each_block(0, matrix.rows(),
                        [&](Index i, Index j, const auto& block) { dense.block<3, 3>(3 * i, 3 * j) = block; });
  return dense;
}

inline void complete(const solver::Assembly& assembly, solver::BlockMatrix& matrix) {
  assembly.complete_pairs(0, matrix.rows(), matrix);
  assembly.complete_rows(0, matrix.rows(), matrix);
}

/// Forces, and −(∂f/∂x + rate ∂f/∂v) as the force adds it to an assembly, including its constant part.
struct Linearised {
  Positions force;
  Eigen::MatrixXd stiffness;
};
inline Linearised linearised(Force& force, const Positions& x, const Positions& v, double rate) {
  std::vector<std::pair<Index, Index>> pairs;
  force.append_couplings(pairs);
  solver::BlockMatrix matrix(static_cast<Index>(x.size()), pairs);
  solver::Assembly assembly(matrix);
  force.attach(assembly);
  force.add_constant_stiffness(assembly);
  Place place(x, v);
  Evaluation at = place.evaluation(rate);
  at.assembly = {assembly, matrix};
  force.add(at);
  complete(assembly, matrix);
  return {place.forces(), dense(matrix)};
}
inline Eigen::MatrixXd stiffness_of(Force& force, const Positions& x, const Positions& v, double rate) {
  return linearised(force, x, v, rate).stiffness;
}

/// Expects that evaluating ranges of particles, from the last to the first, gives the same forces and blocks as
/// evaluating all at once, and that each range writes only the forces of its own particles.
inline void expect_same_bits_in_ranges(Force& force, const Positions& x, const Positions& v, double rate) {
  std::vector<std::pair<Index, Index>> pairs;
  force.append_couplings(pairs);
  const auto count = static_cast<Index>(x.size());
  solver::BlockMatrix at_once(count, pairs), in_ranges = at_once;
  solver::Assembly assembly(at_once);
  force.attach(assembly);
  const std::vector<Index> bounds{0, 1, count / 3, count / 2 + 1, count};
  force.partition(bounds);
  Place all(x, v), parts(x, v);
  Evaluation at = all.evaluation(rate);
  at.assembly = {assembly, at_once};
  force.add(at);
  complete(assembly, at_once);
  assembly.clear();
  for (std::size_t range = bounds.size() - 1; range-- > 0;) {
    const auto before = parts.force;
    Evaluation of_range{parts.x, parts.v, ForceRows(parts.force, bounds[range], bounds[range + 1])};
    of_range.assembly = solver::AssemblyRows(assembly, in_ranges, bounds[range], bounds[range + 1]);
    of_range.rate = rate;
    of_range.range = range;
    force.add(of_range);
    for (Index i = 0; i < count; ++i) {
      if (i >= bounds[range] && i < bounds[range + 1]) continue;
      EXPECT_EQ(solver::vec3_of(parts.force[i]), solver::vec3_of(before[i]));
    }
  }
  complete(assembly, in_ranges);
  for (Index i = 0; i < count; ++i) EXPECT_EQ(solver::vec3_of(parts.force[i]), solver::vec3_of(all.force[i])) << i;
  EXPECT_EQ(dense(in_ranges), dense(at_once));
}

/// Exact −(∂f/∂x + rate ∂f/∂v), not projected to a definite matrix.
inline Eigen::MatrixXd jacobian_of(const Force& force, const Positions& x, const Positions& v, double rate) {
  std::vector<std::pair<Index, Index>> pairs;
  force.append_couplings(pairs);
  solver::BlockMatrix matrix(static_cast<Index>(x.size()), pairs);
  force.add_jacobian(x, v, rate, matrix);
  return dense(matrix);
}

inline Eigen::Map<const Eigen::VectorXd> dense(const Positions& x) {
  return {x.data()->data(), static_cast<Eigen::Index>(3 * x.size())};
}

inline double largest(const Positions& x) {
  return dense(x).cwiseAbs().maxCoeff();
}

/// Expects that the elastic forces are minus the gradient of the energy, by central differences over `step` [m].
/// `tolerance`: relative to the largest force.
inline void expect_forces_from_energy(const Force& force, Positions x, double step, double tolerance) {
  const Positions f = force_of(force, x, zeros(x));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double place = x[i][axis];
      x[i][axis] = place + step;
      const double above = force.energy(x);
      x[i][axis] = place - step;
      const double below = force.energy(x);
      x[i][axis] = place;
      // The second term of the tolerance is the rounding error of the energies, divided by the step.
      EXPECT_NEAR(f[i][axis], -(above - below) / (2 * step), tolerance * largest(f) + 1e-15 * above / step);
    }
}

/// −(∂f/∂x + rate ∂f/∂v) by central differences at ε and at half of it, extrapolated so that the error of order ε²
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
