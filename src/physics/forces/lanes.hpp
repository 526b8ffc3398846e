// Arithmetic on four elements at a time (edges, cells, triangles): one element per lane of a register.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>

#include "core/types.hpp"
#include "physics/forces/force.hpp"
#include "physics/forces/ranges.hpp"
#include "physics/solver/assembly.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::forces {

/// One number per element.
using Lanes = solver::PaddedVec3<double>;
/// One index per element: of a particle, a block, ...
using IndexLanes = std::array<Index, 4>;

inline Lanes lanes_of(double value) {
  return Lanes{value, value, value, value};
}
inline Lanes sqrt(const Lanes& a) {
  Lanes root;
  Eigen::Map<Eigen::Array4d>(reinterpret_cast<double*>(&root)) =
      Eigen::Map<const Eigen::Array4d>(reinterpret_cast<const double*>(&a)).sqrt();
  return root;
}
inline Lanes abs(const Lanes& a) {
  return a < 0 ? -a : a;
}
inline Lanes max(const Lanes& a, const Lanes& b) {
  return a < b ? b : a;
}
inline Lanes min(const Lanes& a, const Lanes& b) {
  return b < a ? b : a;
}

/// One vector per element.
struct VecLanes {
  Lanes x{}, y{}, z{};

  friend VecLanes operator+(const VecLanes& a, const VecLanes& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend VecLanes operator-(const VecLanes& a, const VecLanes& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend VecLanes operator*(const Lanes& s, const VecLanes& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Lanes dot(const VecLanes& a, const VecLanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend VecLanes cross(const VecLanes& a, const VecLanes& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

inline VecLanes operator*(double s, const VecLanes& a) {
  return lanes_of(s) * a;
}
inline VecLanes lanes_of(const Vec3& a) {
  return {lanes_of(a.x()), lanes_of(a.y()), lanes_of(a.z())};
}

/// The vectors of four particles in `of`, transposed: one register per coordinate.
inline VecLanes gather(std::span<const solver::PaddedVec3<double>> of, const IndexLanes& i) {
  const Lanes &a = of[i[0]], &b = of[i[1]], &c = of[i[2]], &d = of[i[3]];
  const Lanes xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7), y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5), __builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7)};
}
inline VecLanes gather(std::span<const Vec3> of, const IndexLanes& i) {
  const Vec3 &a = of[i[0]], &b = of[i[1]], &c = of[i[2]], &d = of[i[3]];
  return {Lanes{a[0], b[0], c[0], d[0]}, Lanes{a[1], b[1], c[1], d[1]}, Lanes{a[2], b[2], c[2], d[2]}};
}

/// Transposes four rows of four numbers.
inline std::array<Lanes, 4> transposed(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  const Lanes ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5), __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5),
          __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7), __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7)};
}

/// Adds the vector of each element to the entry of its particle, in the order of elements.
inline void add(const ForceRows& to, const IndexLanes& i, const VecLanes& value) {
  const auto of = transposed(value.x, value.y, value.z, Lanes{0, 0, 0, 0});
  for (std::size_t l = 0; l < 4; ++l) to.add(i[l], of[l]);
}
inline void subtract(const ForceRows& from, const IndexLanes& i, const VecLanes& value) {
  const auto of = transposed(value.x, value.y, value.z, Lanes{0, 0, 0, 0});
  for (std::size_t l = 0; l < 4; ++l) from.subtract(i[l], of[l]);
}

/// One 3×3 block per element, its entries column by column.
using BlockLanes = std::array<Lanes, 9>;

inline BlockLanes operator+(const BlockLanes& a, const BlockLanes& b) {
  BlockLanes sum;
  for (std::size_t k = 0; k < 9; ++k) sum[k] = a[k] + b[k];
  return sum;
}
inline BlockLanes operator*(const Lanes& s, const BlockLanes& a) {
  BlockLanes product;
  for (std::size_t k = 0; k < 9; ++k) product[k] = s * a[k];
  return product;
}
/// a bᵀ + s I
inline BlockLanes outer(const VecLanes& a, const VecLanes& b, const Lanes& s = Lanes{0, 0, 0, 0}) {
  return {a.x * b.x + s, a.y * b.x, a.z * b.x, a.x * b.y,    a.y * b.y + s,
          a.z * b.y,     a.x * b.z, a.y * b.z, a.z * b.z + s};
}
/// Converts blocks of four elements to one PackedBlock per element.
inline std::array<solver::PackedBlock, 4> packed(const BlockLanes& m) {
  const auto low = transposed(m[0], m[1], m[2], m[3]), high = transposed(m[4], m[5], m[6], m[7]);
  std::array<solver::PackedBlock, 4> blocks;
  for (std::size_t l = 0; l < 4; ++l) blocks[l] = {low[l], high[l], Lanes{m[8][l], 0, 0, 0}};
  return blocks;
}
inline void add(const solver::AssemblyRows& assembly, const IndexLanes& block, const BlockLanes& value) {
  const auto blocks = packed(value);
  for (std::size_t l = 0; l < 4; ++l) assembly.add(block[l], blocks[l]);
}
inline void add_scalars(const solver::AssemblyRows& assembly, const IndexLanes& scalar, const Lanes& value) {
  for (std::size_t l = 0; l < 4; ++l) assembly.add_scalar(scalar[l], value[l]);
}

/// Sets found[pair][lane] to find(i, j) for each pair 01, 02, ... 12, ... of the particles of an element.
template <std::size_t Count, class Find>
void find_pairs(const std::array<IndexLanes, Count>& particles, std::array<IndexLanes, Count*(Count - 1) / 2>& found,
                const Find& find) {
  for (std::size_t a = 0, pair = 0; a < Count; ++a)
    for (std::size_t b = a + 1; b < Count; ++b, ++pair)
      for (std::size_t l = 0; l < 4; ++l) found[pair][l] = find(particles[a][l], particles[b][l]);
}

/// Calls body(index, lane, is_used) for the four lanes of pack number `pack` of `count` elements. In the last pack,
/// lanes after the last element repeat it, with is_used = false.
template <class Body>
void for_each_lane(std::size_t count, std::size_t pack, const Body& body) {
  for (std::size_t l = 0; l < 4; ++l) body(std::min(4 * pack + l, count - 1), l, 4 * pack + l < count);
}
/// Number of packs of four for `count` elements.
inline std::size_t packs_of(std::size_t count) {
  return (count + 3) / 4;
}

/// Calls Ranges::partition() for packs of four elements. all_of(pack) returns the particles of a pack: one IndexLanes
/// per corner.
template <class Pack, class AllOf>
void cut_packs(std::span<const Index> bounds, const std::vector<Pack>& packs, const AllOf& all_of, Ranges& ranges) {
  ranges.partition(bounds, packs.size(), [&](std::size_t p, const auto& visit) {
    for (const IndexLanes& four : all_of(packs[p]))
      for (Index particle : four) visit(particle);
  });
}

}  // namespace weft::forces
