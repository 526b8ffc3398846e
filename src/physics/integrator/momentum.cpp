#include "physics/integrator/momentum.hpp"

#include <cmath>

#include "core/disjoint_sets.hpp"

namespace weft::integrator {

std::vector<Vec3> missing_accelerations(const solver::LinearSystem& linear, std::span<const double> masses,
                                        std::span<const Vec3> residual) {
  const std::vector<solver::DiagonalBlock> blocks = solver::blocks_of(linear);
  const auto block_of = [&](Index particle) { return static_cast<Index>(solver::block_of_row(blocks, particle)); };
  DisjointSets groups(blocks.size());
  std::vector<char> held(blocks.size(), 0);  // a constraint, DiagonalTerm or obstacle acts on the block
  for (const auto& constraint : linear.constraints) held[block_of(constraint.particle)] = 1;
  for (const auto& term : linear.diagonal_terms) held[block_of(term.particle)] = 1;
  solver::for_each_term(linear, [&](const auto& term) {
    double sum = 0;
    Index first = -1;  // block of the first particle with a weight
    for (std::size_t k = 0; k < term.particles.size(); ++k) {
      if (term.weights[k] == 0) continue;
      sum += term.weights[k];
      if (first < 0) first = block_of(term.particles[k]);
      groups.join(first, block_of(term.particles[k]));
    }
    // If the weights do not sum to zero, the term acts against an obstacle.
    if (std::abs(sum) > kRoundoff) held[first] = 1;
  });

  std::vector<Vec3> force(blocks.size(), Vec3::Zero());
  std::vector<double> mass(blocks.size(), 0);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const Index group = groups.root(static_cast<Index>(p));
    held[group] |= held[p];
    for (auto i = static_cast<std::size_t>(blocks[p].begin); i < static_cast<std::size_t>(blocks[p].end); ++i) {
      force[group] += residual[i];
      mass[group] += masses[i];
    }
  }
  std::vector<Vec3> result(blocks.size(), Vec3::Zero());
  for (std::size_t p = 0; p < blocks.size(); ++p)
    if (const Index group = groups.root(static_cast<Index>(p)); held[group] == 0)
      result[p] = force[group] / mass[group];
  return result;
}

}  // namespace weft::integrator
