// Symmetric sparse matrix of 3×3 blocks. Its pattern is fixed; its values change with every linearisation.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// Position of one block among the values of a BlockMatrix. Negative if the pattern allows only a
/// multiple of the identity there: then ~slot is its position among the scalars.
using Slot = Index;

using Lanes = PaddedVec3<double>;

/// A 3×3 block in registers, column by column as the matrix stores it: entries 0 to 3, 4 to 7, and 8.
struct PackedBlock {
  Lanes low, high, last;  // `last` uses only lane 0

  friend PackedBlock operator+(const PackedBlock& a, const PackedBlock& b) {
    return {a.low + b.low, a.high + b.high, a.last + b.last};
  }
  friend PackedBlock operator*(double factor, const PackedBlock& a) {
    return {factor * a.low, factor * a.high, factor * a.last};
  }
  PackedBlock operator-() const { return {-low, -high, -last}; }
};

/// a bᵀ
inline PackedBlock packed_outer(const Vec3& a, const Vec3& b) {
  return {Lanes{a[0], a[1], a[2], a[0]} * Lanes{b[0], b[0], b[0], b[1]},
          Lanes{a[1], a[2], a[0], a[1]} * Lanes{b[1], b[1], b[2], b[2]}, Lanes{a[2] * b[2], 0, 0, 0}};
}
/// `value` times the identity
inline PackedBlock packed_scalar(double value) {
  return {Lanes{value, 0, 0, 0}, Lanes{value, 0, 0, 0}, Lanes{value, 0, 0, 0}};
}

/// Stores the upper and the lower triangle, so that each row of a product is computed on its own, with the same bits on
/// any number of threads. A block that can only be a multiple of the identity is stored as one
/// number. In the matrix of a garment, these are 30 of the 37 blocks of a row, which come from
/// bending alone; there, a product reads a third of the memory that full blocks would need.
class BlockMatrix {
 public:
  BlockMatrix() = default;

  using Couplings = std::vector<std::pair<Index, Index>>;

  /// Pattern of `rows` block rows: the diagonal, and (i, j) and (j, i) for each pair in `couplings`. Pairs in
  /// `isotropic` that are not in `couplings` hold multiples of the identity only. Pairs may repeat.
  BlockMatrix(Index rows, Couplings couplings, Couplings isotropic = {});

  Index rows() const { return static_cast<Index>(layout_->diagonal.size()); }
  std::size_t blocks() const { return full().columns.size() + isotropic().columns.size(); }

  /// Slot of block (row, column), which the pattern must contain.
  Slot slot(Index row, Index column) const;
  Slot diagonal(Index row) const { return layout_->diagonal[row]; }

  void add(Slot slot, const Mat3& block) { add(slot, 1, block); }
  /// Adds `factor` times the block. The slot must not be negative.
  void add(Slot slot, double factor, const Mat3& block) {
    double* value = values_.data() + 9 * static_cast<std::size_t>(slot);
    for (int k = 0; k < 8; k += 4)
      store_padded(value + k, load_padded(value + k) + factor * load_padded(block.data() + k));
    value[8] += factor * block.data()[8];
  }
  void add(Slot slot, const PackedBlock& block) {
    double* value = values_.data() + 9 * static_cast<std::size_t>(slot);
    store_padded(value, load_padded(value) + block.low);
    store_padded(value + 4, load_padded(value + 4) + block.high);
    value[8] += block.last[0];
  }
  /// Adds `value` times the identity.
  void add_scalar(Slot slot, double value) {
    if (slot < 0) {
      scalars_[~slot] += value;
      return;
    }
    double* block = values_.data() + 9 * static_cast<std::size_t>(slot);
    block[0] += value;
    block[4] += value;
    block[8] += value;
  }
  /// Adds the stiffness of a spring between two particles, whose pair must be in the pattern as a full block.
  void add_spring(Index i, Index j, const Mat3& stiffness) {
    for (const Slot own : {diagonal(i), diagonal(j)}) add(own, stiffness);
    for (const Slot between : {slot(i, j), slot(j, i)}) add(between, -1, stiffness);
  }
  Mat3 block(Slot slot) const {
    if (slot < 0) return scalars_[~slot] * Mat3::Identity();
    return Eigen::Map<const Mat3>(values_.data() + 9 * static_cast<std::size_t>(slot));
  }

  /// Trace of a diagonal block.
  double trace(Index row) const {
    const double* block = values_.data() + 9 * static_cast<std::size_t>(diagonal(row));
    return block[0] + block[4] + block[8];
  }

  /// Calls body(row, column, block) for every block of the rows [begin, end), row by row in ascending columns.
  template <class Body>
  void for_each_block(Index begin, Index end, const Body& body) const {
    const auto& [full, isotropic, diagonal] = *layout_;
    for (Index row = begin; row < end; ++row) {
      Index s = full.start[row], t = isotropic.start[row];
      const Index s_end = full.start[static_cast<std::size_t>(row) + 1],
                  t_end = isotropic.start[static_cast<std::size_t>(row) + 1];
      while (s < s_end || t < t_end) {
        const bool is_full = t == t_end || (s < s_end && full.columns[s] < isotropic.columns[t]);
        if (is_full)
          body(row, full.columns[s], block(s)), ++s;
        else
          body(row, isotropic.columns[t], block(~t)), ++t;
      }
    }
  }

  /// y = A x over the rows [begin, end). x and y hold Vec3 or PaddedVec3<double> per block row, and must not overlap.
  template <class Vector>
  void multiply(std::span<const Vector> x, std::span<Vector> y, std::size_t begin, std::size_t end) const;

  /// Positions of blocks in the compressed sparse row format.
  struct Pattern {
    std::vector<Index> start;    ///< rows + 1 entries into columns
    std::vector<Index> columns;  ///< ascending within a row

    /// `pairs` must be sorted and must not repeat.
    static Pattern of(Index rows, const Couplings& pairs);
    /// Index of (row, column); −1 if the pattern does not contain it.
    Index find(Index row, Index column) const;
  };
  /// Which blocks a matrix has.
  struct Layout {
    Pattern full, isotropic;     ///< of the full blocks, and of the multiples of the identity
    std::vector<Slot> diagonal;  ///< per row
  };
  /// Shared by the matrix, its copies, and the objects that read or assemble it.
  const std::shared_ptr<const Layout>& layout() const { return layout_; }
  /// Pattern of the full blocks. values() holds nine numbers for each, column by column, and three more after the last,
  /// so that every column can be loaded as four numbers.
  const Pattern& full() const { return layout_->full; }
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }
  /// Pattern of the multiples of the identity, which scalars() holds.
  const Pattern& isotropic() const { return layout_->isotropic; }
  std::span<const double> scalars() const { return scalars_; }
  std::span<double> scalars() { return scalars_; }

 private:
  std::shared_ptr<const Layout> layout_ = std::make_shared<const Layout>();
  std::vector<double> values_;   // 9 per block, and 3 of padding
  std::vector<double> scalars_;  // per isotropic block
};

}  // namespace weft::solver
