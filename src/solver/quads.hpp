// Vectors of the inner loops: four numbers per particle in one register, the last one zero.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::solver {

template <class Real>
struct QuadOf;
template <>
struct QuadOf<float> {
  using Type = float __attribute__((vector_size(16)));
};
template <>
struct QuadOf<double> {
  using Type = double __attribute__((vector_size(32)));
};
/// Four numbers in one register; the compiler splits them if the CPU has no such register.
template <class Real>
using Quad = typename QuadOf<Real>::Type;

template <class Real>
Quad<Real> load_quad(const Real* p) {
  Quad<Real> quad;
  std::memcpy(&quad, p, sizeof quad);
  return quad;
}
template <class Quad, class Real>
void store_quad(Real* p, const Quad& quad) {
  static_assert(sizeof quad == 4 * sizeof(Real));
  std::memcpy(p, &quad, sizeof quad);
}
/// The same with zero as last number.
inline Quad<float> clear_last_lane(Quad<float> q) {
  return __builtin_shufflevector(q, Quad<float>{}, 0, 1, 2, 4);
}
inline Quad<double> clear_last_lane(Quad<double> q) {
  return __builtin_shufflevector(q, Quad<double>{}, 0, 1, 2, 4);
}

inline Quad<float> quad_of(float x, float y, float z) {
  return Quad<float>{x, y, z, 0};
}
inline Quad<double> quad_of(double x, double y, double z) {
  return Quad<double>{x, y, z, 0};
}
template <class Real>
Quad<Real> quad_of(const Vec3& v) {
  return quad_of(static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2]));
}
template <class Quad>
Vec3 vec3_of(const Quad& q) {
  return {q[0], q[1], q[2]};
}

/// A 3×3 block, stored by columns.
template <class Real>
struct QuadBlock {
  Quad<Real> columns[3]{};

  QuadBlock() = default;
  explicit QuadBlock(const Mat3& block) {
    for (int k = 0; k < 3; ++k) columns[k] = quad_of<Real>(block.col(k));
  }
  Quad<Real> operator*(const Quad<Real>& v) const { return columns[0] * v[0] + columns[1] * v[1] + columns[2] * v[2]; }
};

/// Products entry by entry, computed in double.
template <class Quad>
weft::solver::Quad<double> products(const Quad& a, const Quad& b) {
  return __builtin_convertvector(a, weft::solver::Quad<double>) *
         __builtin_convertvector(b, weft::solver::Quad<double>);
}
inline double sum_of_first_three(const Quad<double>& q) {
  return q[0] + q[1] + q[2];
}

}  // namespace weft::solver
