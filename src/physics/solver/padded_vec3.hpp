// Vectors of the inner loops: four numbers per particle in one register, of which the last one is zero.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace weft::solver {

template <class Real>
struct PaddedVec3Of;
template <>
struct PaddedVec3Of<float> {
  using Type = float __attribute__((vector_size(16)));
};
template <>
struct PaddedVec3Of<double> {
  using Type = double __attribute__((vector_size(32)));
};
/// Four numbers in one register; the compiler splits them if the CPU has no such register.
template <class Real>
using PaddedVec3 = typename PaddedVec3Of<Real>::Type;

template <class Real>
PaddedVec3<Real> load_padded(const Real* p) {
  PaddedVec3<Real> value;
  std::memcpy(&value, p, sizeof value);
  return value;
}
template <class Padded, class Real>
void store_padded(Real* p, const Padded& value) {
  static_assert(sizeof value == 4 * sizeof(Real));
  std::memcpy(p, &value, sizeof value);
}
/// Returns q with zero as its last number.
inline PaddedVec3<float> clear_last_lane(PaddedVec3<float> q) {
  return __builtin_shufflevector(q, PaddedVec3<float>{}, 0, 1, 2, 4);
}

inline PaddedVec3<float> padded(float x, float y, float z) {
  return PaddedVec3<float>{x, y, z, 0};
}
inline PaddedVec3<double> padded(double x, double y, double z) {
  return PaddedVec3<double>{x, y, z, 0};
}
template <class Real>
PaddedVec3<Real> padded(const Vec3& v) {
  return padded(static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2]));
}
template <class Padded>
Vec3 vec3_of(const Padded& q) {
  return {q[0], q[1], q[2]};
}

/// A 3×3 block, stored by columns.
template <class Real>
struct PaddedMat3 {
  PaddedVec3<Real> columns[3]{};

  PaddedMat3() = default;
  explicit PaddedMat3(const Mat3& block) {
    for (int k = 0; k < 3; ++k) columns[k] = padded<Real>(block.col(k));
  }
  PaddedVec3<Real> operator*(const PaddedVec3<Real>& v) const {
    return columns[0] * v[0] + columns[1] * v[1] + columns[2] * v[2];
  }
};

/// Products entry by entry, computed in double.
template <class Padded>
PaddedVec3<double> products(const Padded& a, const Padded& b) {
  return __builtin_convertvector(a, PaddedVec3<double>) * __builtin_convertvector(b, PaddedVec3<double>);
}
inline double sum_of_first_three(const PaddedVec3<double>& q) {
  return q[0] + q[1] + q[2];
}

}  // namespace weft::solver
