// The linear system of one Newton iteration: the assembled matrix, the terms of contacts and
// springs, and constraints.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/solver/block_matrix.hpp"
#include "physics/solver/row_chunks.hpp"

namespace weft::solver {

/// Directions in which a particle may move: the solution stays in the range of `free` (Baraff & Witkin, "Large Steps in
/// Cloth Simulation", 1998, section 5). Zero pins the particle; I − n nᵀ keeps it from moving along n.
struct ParticleConstraint {
  Index particle = 0;
  Mat3 free = Mat3::Zero();  ///< a projection: symmetric, free² = free
};

/// Contribution w wᵀ ⊗ stiffness of a contact or attachment to the matrix: a spring against the
/// weighted sum of the particles' displacements, with the weights w. Contacts change with every
/// step; therefore the sparsity pattern of the matrix does not contain them. Below, "contact terms"
/// also stand for attachments and springs of pins.
struct StencilTerm {
  std::array<Index, 4> particles{0, 0, 0, 0};
  std::array<double, 4> weights{0, 0, 0, 0};  ///< zero for unused entries
  Mat3 stiffness = Mat3::Zero();              ///< symmetric, positive semidefinite [N/m]
};

/// A StencilTerm for contacts and attachments of rigid bodies: a point on a body is a weighted sum
/// of the four particles of the body.
struct WideTerm {
  std::array<Index, 8> particles{};
  std::array<double, 8> weights{};
  Mat3 stiffness = Mat3::Zero();
};

/// A StencilTerm for a single particle, with the weight 1.
struct DiagonalTerm {
  Index particle = 0;
  Mat3 stiffness = Mat3::Zero();  ///< symmetric, positive semidefinite [N/m]
};

/// stiffness · d dᵀ over the rows of one diagonal block: the contribution of a quantity that depends on all of the
/// block's particles, such as the enclosed volume (d is its derivative). Such terms are few and
/// dense, so the matrix does not contain them.
struct RankOneTerm {
  Index begin = 0;              ///< first row
  std::vector<Vec3> direction;  ///< d, one entry per row from `begin` on
  double stiffness = 0;         ///< at least 0
};

/// Partition of particles, or of the aggregates of the next finer level, into aggregates.
struct Aggregates {
  std::vector<Index> of;  ///< aggregate of each member, 0 to count − 1
  Index count = 0;
};

/// Maximum number of levels of aggregates, the coarsest included; the preconditioner has arrays of this size.
inline constexpr std::size_t kMaxAggregateLevels = 64;

/// A diagonal block: rows [begin, end), such as the particles of one cloth, that the matrix does not couple with other
/// rows. Contact terms may couple different diagonal blocks.
struct DiagonalBlock {
  Index begin = 0, end = 0;
  std::uint64_t version = 1;  ///< changes whenever the values of these rows change
  /// Few rows with stiff forces between them, such as the four particles of a rigid body. On every
  /// level of the preconditioner, each of these particles must be an aggregate of its own; then the
  /// coarsest level solves the block exactly.
  bool is_small = false;
};

struct LinearSystem {
  BlockMatrix matrix;                 ///< positive definite on the free directions
  std::vector<DiagonalBlock> blocks;  ///< of all rows, ascending; empty: one diagonal block
  std::vector<StencilTerm> terms;
  std::vector<WideTerm> wide_terms;
  std::vector<DiagonalTerm> diagonal_terms;
  std::vector<RankOneTerm> rank_one_terms;
  std::vector<ParticleConstraint> constraints;  ///< at most one per particle
  /// Weights of the mass-weighted norm of errors, rate² m, one per row. As a diagonal matrix they must not exceed the
  /// system's matrix, rate² M + K. Empty: errors are measured in the energy norm.
  std::vector<double> norm_weights;
  /// Multigrid levels of the preconditioner, finest first: aggregates of particles, aggregates of those, and so on. The
  /// coarsest level must be small enough for a dense factorisation. No aggregate spans two diagonal blocks, and the
  /// aggregates of one diagonal block have consecutive numbers. Empty: no coarse level.
  std::vector<Aggregates> aggregate_levels;
};

/// Calls visit(term) for each StencilTerm, then for each WideTerm.
template <class Visit>
void for_each_term(const LinearSystem& system, const Visit& visit) {
  for (const StencilTerm& term : system.terms) visit(term);
  for (const WideTerm& term : system.wide_terms) visit(term);
}

/// A DiagonalTerm, StencilTerm or WideTerm.
struct AnyTerm {
  std::span<const Index> particles;
  std::span<const double> weights;
  const Mat3& stiffness;
};

/// Number of terms of these three kinds.
inline std::size_t term_count(const LinearSystem& system) {
  return system.diagonal_terms.size() + system.terms.size() + system.wide_terms.size();
}

/// The term with this number: diagonal terms come first, then the others in the order of for_each_term().
inline AnyTerm term_at(const LinearSystem& system, std::size_t number) {
  static constexpr double kWeightOfOne = 1;
  const std::size_t diagonal = system.diagonal_terms.size(), small = diagonal + system.terms.size();
  if (number < diagonal) {
    const DiagonalTerm& term = system.diagonal_terms[number];
    return {{&term.particle, 1}, {&kWeightOfOne, 1}, term.stiffness};
  }
  if (number < small) {
    const StencilTerm& term = system.terms[number - diagonal];
    return {term.particles, term.weights, term.stiffness};
  }
  const WideTerm& term = system.wide_terms[number - small];
  return {term.particles, term.weights, term.stiffness};
}

/// The diagonal blocks of a system; if it lists none, one block of all rows.
inline std::vector<DiagonalBlock> blocks_of(const LinearSystem& system) {
  return system.blocks.empty() ? std::vector<DiagonalBlock>{{0, system.matrix.rows()}} : system.blocks;
}

/// Index of the diagonal block that contains this row.
inline std::size_t block_of_row(std::span<const DiagonalBlock> blocks, Index row) {
  const auto after = std::ranges::upper_bound(blocks, row, {}, &DiagonalBlock::begin);
  return static_cast<std::size_t>(after - blocks.begin()) - 1;
}

/// The rows of the diagonal blocks with these indices.
inline std::vector<RowRange> ranges_of(std::span<const DiagonalBlock> blocks, std::span<const std::size_t> numbers) {
  std::vector<RowRange> ranges;
  for (std::size_t p : numbers)
    ranges.push_back({static_cast<std::size_t>(blocks[p].begin), static_cast<std::size_t>(blocks[p].end)});
  return ranges;
}

}  // namespace weft::solver
