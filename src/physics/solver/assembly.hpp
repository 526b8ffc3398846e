// Assembles the matrix of all particles from one block for each pair of particles.
#pragma once

#include <memory>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/block_matrix.hpp"

namespace weft::solver {

/// Assembles the symmetric BlockMatrix of the forces and masses of all particles. Forces between
/// particles do not change if all particles translate together, so the blocks of these forces sum
/// to zero in each row. Therefore such forces add only the block (i, j) of each pair of particles
/// i < j: a triangle adds three blocks instead of nine. Each particle also has its own block, to
/// which the terms of this particle alone are added (its mass, the drag of air). complete_rows()
/// sets each block (j, i) to the transpose of block (i, j), and each diagonal block such that its
/// row sums to the own block. Before complete_rows(), the diagonal block holds the own block
/// without its constant part.
///
/// Bending adds scalar multiples of the identity; each pair stores that scalar, part of which is constant.
class Assembly {
 public:
  Assembly() = default;
  /// For matrices with the layout of `matrix`.
  explicit Assembly(const BlockMatrix& matrix);

  /// Index of block (i, j), i < j. The pattern must contain it as a full block.
  Index block(Index i, Index j) const;
  /// Index of a pair's scalar, in either order.
  Index scalar(Index i, Index j) const;

  /// Sets all scalars, their constant parts, and the constant parts of all own blocks to zero.
  void clear();
  /// Makes the scalars added so far the constant part.
  void keep_constant();
  /// Resets the rows [begin, end): sets their own blocks (without the constant parts), and the
  /// blocks of all pairs whose smaller index is in this range, to zero. Sets the scalars of these
  /// pairs to their constant part.
  void start(Index begin, Index end, BlockMatrix& matrix);

  /// Adds `value` times the identity to the constant part of a row's own block.
  void add_constant_to_own(Index row, double value) { constant_own_[at(row)] += value; }
  void add_scalar(Index scalar, double value) { scalars_[at(scalar)] += value; }

  /// Call it after all forces have added their blocks: adds the scalars of the pairs whose smaller
  /// index is in [begin, end) to the full blocks of these pairs.
  void complete_pairs(Index begin, Index end, BlockMatrix& matrix) const;
  /// Call it after complete_pairs() for all pairs of the particles [begin, end): completes the rows
  /// of these particles.
  void complete_rows(Index begin, Index end, BlockMatrix& matrix) const;

 private:
  friend class AssemblyRows;

  std::shared_ptr<const BlockMatrix::Layout> layout_;
  BlockMatrix::Pattern pairs_;   // all pairs
  std::vector<double> scalars_;  // per pair
  std::vector<double> constant_scalars_;
  std::vector<double> constant_own_;        // per row, a multiple of the identity
  std::vector<Index> scalar_of_pair_;       // of each full block above the diagonal, row by row: its pair's scalar
  std::vector<Index> pair_of_;              // of each full block below the diagonal, row by row: its transpose
  std::vector<Index> first_of_row_;         // per row: its first entry in pair_of_
  std::vector<Index> scalar_of_isotropic_;  // of each isotropic block, row by row: its pair's scalar
};

/// Adds to the own blocks of the rows [begin, end) during the assembly of a matrix, and to the
/// pairs whose smaller index is in this range. Ignores values for other rows and pairs. If each
/// thread owns a range of rows and adds all elements of this range in the same order as one thread
/// would, the sums have the same bits as with one thread. A default-constructed object has no
/// matrix and converts to false.
class AssemblyRows {
 public:
  AssemblyRows() = default;
  /// Accepts scalars of all pairs, but no blocks.
  AssemblyRows(Assembly& assembly) : assembly_(&assembly), scalars_{0, static_cast<Index>(assembly.scalars_.size())} {}
  AssemblyRows(Assembly& assembly, BlockMatrix& matrix) : AssemblyRows(assembly, matrix, 0, matrix.rows()) {}
  AssemblyRows(Assembly& assembly, BlockMatrix& matrix, Index begin, Index end)
      : assembly_(&assembly),
        matrix_(&matrix),
        rows_{begin, end},
        blocks_{matrix.full().start[at(begin)], matrix.full().start[at(end)]},
        scalars_{assembly.pairs_.start[at(begin)], assembly.pairs_.start[at(end)]} {}

  explicit operator bool() const { return assembly_ != nullptr; }

  Index block(Index i, Index j) const { return assembly_->block(i, j); }

  void add_scalar(Index scalar, double value) const {
    if (scalars_.has(scalar)) assembly_->add_scalar(scalar, value);
  }
  template <class Block>
  void add(Index block, const Block& value) const {
    if (blocks_.has(block)) matrix_->add(block, value);
  }
  /// Adds a symmetric block to a row's own block.
  void add_to_own_block(Index row, const PackedBlock& value) const {
    if (rows_.has(row)) matrix_->add(matrix_->diagonal(row), value);
  }

 private:
  struct Range {
    Index begin = 0, end = 0;
    bool has(Index i) const { return i >= begin && i < end; }
  };
  Assembly* assembly_ = nullptr;
  BlockMatrix* matrix_ = nullptr;
  Range rows_, blocks_, scalars_;
};

}  // namespace weft::solver
