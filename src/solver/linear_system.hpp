// The linear system of one Newton iteration: assembled blocks, contacts beside them, constraints around both.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "solver/block_matrix.hpp"
#include "solver/row_chunks.hpp"

namespace weft::solver {

/// Directions in which a particle may move: the solution stays in the range of `free` (Baraff & Witkin, "Large Steps in
/// Cloth Simulation", 1998, section 5). Zero pins the particle, I − n nᵀ keeps it from moving along n.
struct ParticleConstraint {
  Index particle = 0;
  Mat3 free = Mat3::Zero();  ///< a projection: symmetric, free² = free
};

/// A spring between weighted sums of particles, wᵀw ⊗ stiffness: what a contact adds to the matrix. Contacts come and
/// go with every step, so they are kept out of the fixed pattern.
struct StencilTerm {
  std::array<Index, 4> particles{0, 0, 0, 0};
  std::array<double, 4> weights{0, 0, 0, 0};  ///< zero for entries that are no particles
  Mat3 stiffness = Mat3::Zero();              ///< symmetric, positive semidefinite [N/m]
};

/// As StencilTerm for points that more particles carry: those of a rigid body follow its four frame particles.
struct WideTerm {
  std::array<Index, 8> particles{};
  std::array<double, 8> weights{};
  Mat3 stiffness = Mat3::Zero();
};

/// As StencilTerm for a single particle.
struct DiagonalTerm {
  Index particle = 0;
  Mat3 stiffness = Mat3::Zero();  ///< symmetric, positive semidefinite [N/m]
};

/// stiffness · d dᵀ over the rows of one part: what a quantity of all its particles adds, such as the enclosed volume
/// (d its derivative). Few, and dense, so that they are kept out of the matrix.
struct RankOneTerm {
  Index begin = 0;              ///< first row
  std::vector<Vec3> direction;  ///< d, of each row from there on
  double stiffness = 0;         ///< at least 0
};

/// Groups that the particles are cut into, or smaller groups.
struct Grouping {
  std::vector<Index> of;  ///< group of each member, 0 to count − 1
  Index count = 0;
};

/// Rows [begin, end) that the matrix does not couple with others; terms may.
struct Part {
  Index begin = 0, end = 0;
  std::uint64_t version = 1;  ///< another number whenever the values of these rows change
  /// Few rows that are stiff against each other, as those of a rigid body: the preconditioner solves them exactly, as
  /// particles that are aggregates on every level.
  bool is_small = false;
};

struct LinearSystem {
  BlockMatrix matrix;       ///< positive definite on the free directions
  std::vector<Part> parts;  ///< all rows, in their order; empty: they are one part
  std::vector<StencilTerm> terms;
  std::vector<WideTerm> wide_terms;
  std::vector<DiagonalTerm> diagonal_terms;
  std::vector<RankOneTerm> rank_one_terms;
  std::vector<ParticleConstraint> constraints;  ///< at most one per particle
  /// What errors of solutions are weighed with, a weight of each row; no more than the matrix, as rate² M is no more
  /// than rate² M + K. Empty: their energy counts instead.
  std::vector<double> metric;
  /// Coarse levels of the preconditioner, which moves groups as a whole: of particles, of those groups, and so on, the
  /// last of them few enough for a dense factorisation. No group spans two parts, and those of one part have
  /// consecutive numbers. Empty: no coarse level.
  std::vector<Grouping> groupings;
};

/// Calls visit(term) for each StencilTerm and each WideTerm.
template <class Visit>
void for_each_term(const LinearSystem& system, const Visit& visit) {
  for (const StencilTerm& term : system.terms) visit(term);
  for (const WideTerm& term : system.wide_terms) visit(term);
}

inline std::vector<Part> parts_of(const LinearSystem& system) {
  return system.parts.empty() ? std::vector<Part>{{0, system.matrix.rows()}} : system.parts;
}

/// The rows of some of these parts, by their numbers.
inline std::vector<RowRange> ranges_of(std::span<const Part> parts, std::span<const std::size_t> numbers) {
  std::vector<RowRange> ranges;
  for (std::size_t p : numbers)
    ranges.push_back({static_cast<std::size_t>(parts[p].begin), static_cast<std::size_t>(parts[p].end)});
  return ranges;
}

}  // namespace weft::solver
