// What the matrix of a cloth is put together from, half of it: one block for each pair of particles.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "solver/block_matrix.hpp"
#include "solver/quads.hpp"

namespace weft::solver {

/// A symmetric matrix of forces that do not change where all particles move alike: its block (i, j) for each pair of
/// particles i < j, and what each particle has of its own (its mass, drag of air). Block (j, i) is the transpose, and
/// the block on the diagonal what is left for the row to have the sum of its own: forces add nothing there. A third of
/// the sums of a full matrix.
///
/// Pairs have a number besides for multiples of the unit matrix, of which bending consists; part of it is constant.
class Assembly {
 public:
  Assembly() = default;
  /// For matrices of the pattern of this one.
  explicit Assembly(const BlockMatrix& matrix);

  /// Where the block of rows i and columns j of a pair, i < j, is summed up. The pattern must hold it, as a full block.
  Index block(Index i, Index j) const;
  /// Where multiples of the unit matrix are, in either order.
  Index scalar(Index i, Index j) const;

  /// Nothing at all, and no constant part.
  void clear();
  /// What has been added of multiples of the unit matrix is the constant part.
  void keep_constant();
  /// Begins the pairs of the rows [begin, end) with their larger ones, and these rows, anew: with the constant part.
  void start(Index begin, Index end);

  void add_constant_to_own(Index row, double value) { constant_own_[static_cast<std::size_t>(row)] += value; }
  void add_scalar(Index scalar, double value) { scalars_[static_cast<std::size_t>(scalar)] += value; }
  void add(Index block, const PackedBlock& value) { add_at(blocks_, block, value); }
  void add(Index block, const Mat3& value) { add(block, packed(value)); }
  /// To what a row has of its own, symmetric.
  void add_to_own(Index row, const PackedBlock& value) { add_at(own_, row, value); }

  /// Rows [begin, end) of the matrix, of the same pattern.
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

  // Patterns: of full blocks above the diagonal, and of all pairs.
  BlockMatrix::Pattern full_, pairs_;
  std::vector<double> blocks_;   // 9 each, column by column
  std::vector<double> scalars_;  // per pair
  std::vector<double> constant_scalars_;
  std::vector<double> own_;           // 9 per row, beside the constant part
  std::vector<double> constant_own_;  // per row, of the unit matrix
  // Where the matrix has it from: per full block (−1 on the diagonal), and per multiple of the unit matrix.
  std::vector<Index> block_of_, scalar_of_full_, scalar_of_isotropic_;
};

/// The rows [begin, end) of an assembly, with the pairs whose smaller row is there, or none: what is added to others is
/// left out. Who adds all elements in their order to each of several such ranges, in threads, gets the same sums as in
/// one go.
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

  /// As Assembly::block().
  Index block(Index i, Index j) const { return assembly_->block(i, j); }

  void add_scalar(Index scalar, double value) const {
    if (scalars_.has(scalar)) assembly_->add_scalar(scalar, value);
  }
  template <class Block>
  void add(Index block, const Block& value) const {
    if (blocks_.has(block)) assembly_->add(block, value);
  }
  void add_to_own(Index row, const PackedBlock& value) const {
    if (rows_.has(row)) assembly_->add_to_own(row, value);
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
