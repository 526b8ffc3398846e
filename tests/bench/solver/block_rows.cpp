#include "bench/solver/block_rows.hpp"

#include <algorithm>

namespace weft::bench {

BlockRows<Mat3> assembled(const solver::LinearSystem& system) {
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  std::vector<const Mat3*> free(rows, nullptr);
  for (const auto& c : system.constraints) free[at(c.particle)] = &c.free;
  std::vector<std::vector<std::pair<Index, Mat3>>> extra(rows);
  for (const auto& term : system.diagonal_terms) extra[at(term.particle)].emplace_back(term.particle, term.stiffness);
  for (const auto& term : system.terms)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (const double weight = term.weights[a] * term.weights[b]; weight != 0)
          extra[at(term.particles[a])].emplace_back(term.particles[b], weight * term.stiffness);

  BlockRows<Mat3> result;
  result.columns = system.matrix.rows();
  result.column.reserve(system.matrix.blocks());
  result.value.reserve(system.matrix.blocks());
  std::vector<std::pair<Index, Mat3>> row;
  for (Index i = 0; i < system.matrix.rows(); ++i) {
    row.clear();
    system.matrix.for_each_block(i, i + 1, [&](Index, Index j, const auto& block) { row.emplace_back(j, block); });
    for (const auto& [j, block] : extra[at(i)]) {
      const auto found =
          std::lower_bound(row.begin(), row.end(), j, [](const auto& e, Index c) { return e.first < c; });
      if (found != row.end() && found->first == j)
        found->second += block;
      else
        row.emplace(found, j, block);
    }
    for (auto& [j, block] : row) {
      if (free[at(i)] != nullptr) block = (*free[at(i)] * block).eval();
      if (free[at(j)] != nullptr) block = (block * *free[at(j)]).eval();
      if (i == j && free[at(i)] != nullptr) block += Mat3::Identity() - *free[at(i)];
      result.column.push_back(j);
      result.value.push_back(block);
    }
    result.start.push_back(result.column.size());
  }
  return result;
}

}  // namespace weft::bench
