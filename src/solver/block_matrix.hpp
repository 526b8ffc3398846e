// Symmetric sparse matrix of 3×3 blocks whose pattern is fixed while its values change with every linearisation.
#pragma once

#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace weft::solver {

/// Position of one block among the values of a BlockMatrix.
using Slot = Index;

/// Block rows with both triangles stored: the product is then one gather per row, free of write conflicts, so it
/// gives the same bits on any number of threads.
class BlockMatrix {
 public:
  BlockMatrix() = default;

  /// Pattern of `rows` block rows: the diagonal, and (i, j) and (j, i) for each of `couplings`. Repeats are welcome.
  BlockMatrix(Index rows, std::vector<std::pair<Index, Index>> couplings);

  Index rows() const { return static_cast<Index>(diagonal_.size()); }
  std::size_t blocks() const { return columns_.size(); }

  /// Where block (row, column) lives. The pattern must hold it.
  Slot slot(Index row, Index column) const;
  Slot diagonal(Index row) const { return diagonal_[static_cast<std::size_t>(row)]; }

  void set_zero();
  /// Takes over the rows [begin, end) of a matrix of the same pattern.
  void copy_rows(const BlockMatrix& other, Index begin, Index end);

  void add(Slot slot, const Mat3& block) { add(slot, 1, block); }
  void subtract(Slot slot, const Mat3& block) { add(slot, -1, block); }
  /// Adds `factor` times the block.
  void add(Slot slot, double factor, const Mat3& block) {
    double* value = values_.data() + 9 * static_cast<std::size_t>(slot);
    for (int k = 0; k < 8; k += 4) store(value + k, load(value + k) + factor * load(block.data() + k));
    value[8] += factor * block.data()[8];
  }
  /// Adds `value` times the unit matrix.
  void add_scalar(Slot slot, double value);
  Mat3 block(Slot slot) const { return Eigen::Map<const Mat3>(values_.data() + 9 * static_cast<std::size_t>(slot)); }

  /// Calls body(row, column, block) for every block of the rows [begin, end), row by row.
  template <class Body>
  void for_each_block(Index begin, Index end, const Body& body) const {
    for (Index row = begin; row < end; ++row)
      for (Slot s = row_start_[static_cast<std::size_t>(row)]; s < row_start_[static_cast<std::size_t>(row) + 1]; ++s)
        body(row, columns_[static_cast<std::size_t>(s)],
             Eigen::Map<const Mat3>(values_.data() + 9 * static_cast<std::size_t>(s)));
  }

  /// y = A x over the rows [begin, end); x and y have one entry per block row and must not overlap.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y, std::size_t begin, std::size_t end) const;

 private:
  // Four doubles in one register where the CPU has it; the compiler splits it where it does not.
  using Lanes = double __attribute__((vector_size(32)));
  static Lanes load(const double* p) {
    Lanes lanes;
    std::memcpy(&lanes, p, sizeof lanes);
    return lanes;
  }
  static void store(double* p, const Lanes& lanes) { std::memcpy(p, &lanes, sizeof lanes); }

  std::vector<Index> row_start_;  // rows + 1 entries into columns_
  std::vector<Index> columns_;    // ascending within a row
  std::vector<Slot> diagonal_;    // per row
  std::vector<double> values_;    // 9 per block, column-major, and 3 more at the end so that a column loads as four
};

}  // namespace weft::solver
