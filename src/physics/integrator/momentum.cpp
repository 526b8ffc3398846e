#include "physics/integrator/momentum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace weft::integrator {
namespace {

/// Disjoint sets of diagonal blocks, each identified by the lowest index of its blocks.
class BlockGroups {
 public:
  explicit BlockGroups(std::span<const solver::DiagonalBlock> blocks)
      : blocks_(blocks), lowest_(blocks.size()), is_free_(blocks.size(), 1) {
    std::iota(lowest_.begin(), lowest_.end(), std::size_t{0});
  }
  std::size_t of_block(std::size_t block) const {
    while (lowest_[block] != block) block = lowest_[block];
    return block;
  }
  std::size_t of_particle(Index particle) const {
    const auto after = std::ranges::upper_bound(blocks_, particle, {}, &solver::DiagonalBlock::begin);
    return of_block(static_cast<std::size_t>(after - blocks_.begin()) - 1);
  }
  std::size_t join(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax(a, b);
    lowest_[high] = low;
    is_free_[low] = is_free_[low] && is_free_[high];
    return low;
  }
  void mark_as_held(std::size_t group) { is_free_[group] = 0; }
  bool is_free(std::size_t group) const { return is_free_[group] != 0; }

 private:
  std::span<const solver::DiagonalBlock> blocks_;
  std::vector<std::size_t> lowest_;
  std::vector<char> is_free_;  // per group: no constraint, DiagonalTerm or obstacle acts on it
};

// Joins the groups of the particles of a term. If the weights do not sum to zero, the term acts against an obstacle,
// which holds the group.
template <class Term>
void join_by_term(const Term& term, BlockGroups& groups) {
  double sum = 0;
  int first = -1;
  for (std::size_t k = 0; k < term.particles.size(); ++k) {
    if (term.weights[k] == 0) continue;
    sum += term.weights[k];
    if (first < 0)
      first = static_cast<int>(k);
    else
      groups.join(groups.of_particle(term.particles[first]), groups.of_particle(term.particles[k]));
  }
  if (first >= 0 && std::abs(sum) > kRoundoff) groups.mark_as_held(groups.of_particle(term.particles[first]));
}

}  // namespace

std::vector<Vec3> missing_accelerations(const solver::LinearSystem& linear, std::span<const double> masses,
                                        std::span<const Vec3> residual) {
  const std::vector<solver::DiagonalBlock> blocks = solver::blocks_of(linear);
  BlockGroups groups(blocks);
  for (const auto& constraint : linear.constraints) groups.mark_as_held(groups.of_particle(constraint.particle));
  for (const auto& term : linear.diagonal_terms) groups.mark_as_held(groups.of_particle(term.particle));
  solver::for_each_term(linear, [&](const auto& term) { join_by_term(term, groups); });

  std::vector<Vec3> force(blocks.size(), Vec3::Zero());
  std::vector<double> mass(blocks.size(), 0);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const std::size_t group = groups.of_block(p);
    for (auto i = static_cast<std::size_t>(blocks[p].begin); i < static_cast<std::size_t>(blocks[p].end); ++i) {
      force[group] += residual[i];
      mass[group] += masses[i];
    }
  }
  std::vector<Vec3> result(blocks.size(), Vec3::Zero());
  for (std::size_t p = 0; p < blocks.size(); ++p)
    if (const std::size_t group = groups.of_block(p); groups.is_free(group)) result[p] = force[group] / mass[group];
  return result;
}

}  // namespace weft::integrator
