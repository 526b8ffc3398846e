// Half of a cloth's matrix while it is assembled: one block for each pair of particles.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/block_matrix.hpp"
#include "physics/solver/padded_vec3.hpp"

namespace weft::solver {

/// A symmetric matrix of forces that do not change if all particles translate together. It stores block (i, j) for each
/// pair of particles i < j, and the own block of each particle (its mass, drag of air). Block (j, i) is the transpose.
/// The diagonal block follows from the condition that each row sums to its particle's own block. Forces between
/// particles therefore add no diagonal blocks: a triangle adds three blocks instead of nine.
///
/// Bending adds scalar multiples of the identity; each pair stores that scalar, part of which is constant.
class Assembly {
 public:
  Assembly() = default;
  /// For matrices with the pattern of `matrix`.
  explicit Assembly(const BlockMatrix& matrix);

  /// Index of block (i, j), i < j. The pattern must hold it as a full block.
  Index block(Index i, Index j) const;
  /// Index of a pair's scalar, in either order.
  Index scalar(Index i, Index j) const;

  /// Sets all values to zero, the constant part included.
  void clear();
  /// Makes the scalars added so far the constant part.
  void keep_constant();
  /// Resets the rows [begin, end) to the constant part: their own blocks, and the scalars and blocks of all pairs whose
  /// smaller index is in this range.
  void start(Index begin, Index end);

  void add_constant_to_own(Index row, double value) { constant_own_[static_cast<std::size_t>(row)] += value; }
  void add_scalar(Index scalar, double value) { scalars_[static_cast<std::size_t>(scalar)] += value; }
  void add(Index block, const PackedBlock& value) { add_at(blocks_, block, value); }
  void add(Index block, const Mat3& value) { add(block, packed(value)); }
  /// Adds a symmetric block to a row's own block.
  void add_to_own_block(Index row, const PackedBlock& value) { add_at(own_, row, value); }

  /// Writes the rows [begin, end) of a matrix that has the pattern of this assembly.
  void write_rows(Index begin, Index end, BlockMatrix& matrix) const;

 private:
  friend class AssemblyRows;
  static PackedBlock packed(const Mat3& m) {
    return {load_lanes(m.data()), load_lanes(m.data() + 4), Lanes{m(2, 2), 0, 0, 0}};
  }
  static void add_at(std::vector<double>& values, Index index, const PackedBlock& value) {
    double* at = values.data() + 9 * static_cast<std::size_t>(index);
    store_lanes(at, load_lanes(at) + value.low);
    store_lanes(at + 4, load_lanes(at + 4) + value.high);
    at[8] += value.last[0];
  }

  // Patterns of the full blocks above the diagonal, and of all pairs.
  BlockMatrix::Pattern full_, pairs_;
  std::vector<double> blocks_;   // 9 per full block, column by column
  std::vector<double> scalars_;  // per pair
  std::vector<double> constant_scalars_;
  std::vector<double> own_;           // 9 per row, without the constant part
  std::vector<double> constant_own_;  // per row, a multiple of the identity
  // Source of each block of the matrix: per full block (−1 on the diagonal), and per isotropic block.
  std::vector<Index> block_of_, scalar_of_full_, scalar_of_isotropic_;
};

/// The rows [begin, end) of an assembly, and the pairs whose smaller index is in this range. Ignores values added to
/// other rows. If each thread owns a range of rows and adds all elements in the same order, the sums have the same bits
/// as with one thread. A default-constructed object holds no rows.
class AssemblyRows {
 public:
  AssemblyRows() = default;
  AssemblyRows(Assembly& assembly) : AssemblyRows(assembly, 0, static_cast<Index>(assembly.constant_own_.size())) {}
  AssemblyRows(Assembly& assembly, Index begin, Index end)
      : assembly_(&assembly),
        rows_{begin, end},
        blocks_{assembly.full_.start[static_cast<std::size_t>(begin)],
                assembly.full_.start[static_cast<std::size_t>(end)]},
        scalars_{assembly.pairs_.start[static_cast<std::size_t>(begin)],
                 assembly.pairs_.start[static_cast<std::size_t>(end)]} {}

  explicit operator bool() const { return assembly_ != nullptr; }

  Index block(Index i, Index j) const { return assembly_->block(i, j); }

  void add_scalar(Index scalar, double value) const {
    if (scalars_.has(scalar)) assembly_->add_scalar(scalar, value);
  }
  template <class Block>
  void add(Index block, const Block& value) const {
    if (blocks_.has(block)) assembly_->add(block, value);
  }
  void add_to_own_block(Index row, const PackedBlock& value) const {
    if (rows_.has(row)) assembly_->add_to_own_block(row, value);
  }

 private:
  struct Range {
    Index begin = 0, end = 0;
    bool has(Index i) const { return i >= begin && i < end; }
  };
  Assembly* assembly_ = nullptr;
  Range rows_, blocks_, scalars_;
};

}  // namespace weft::solver
