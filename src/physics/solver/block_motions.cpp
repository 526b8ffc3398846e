#include "physics/solver/block_motions.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/parallel.hpp"

namespace weft::solver {
namespace {

// A motion is skipped if less than this fraction of its energy is independent of the directions before it.
constexpr double kMinIndependentEnergy = 1e-4;

using Block = Eigen::Matrix<double, kDirections, kDirections>;

// Row k: weighted sum of direction k over those particles of a term that belong to one diagonal
// block. Row k times the term's stiffness, times the term's weighted sum of displacements, is the
// work of the term's force along direction k.
using TermForces = Eigen::Matrix<double, kDirections, 3>;

// Contributions of terms to the projected system (lower triangle), and to its products with the motions, per diagonal
// block.
class TermBlocks {
 public:
  explicit TermBlocks(std::size_t count) : products(count, BlockMotions::Products::Zero()) {}

  void add(std::span<const std::pair<int, TermForces>> of_blocks, const Mat3& stiffness) {
    TermForces all = TermForces::Zero();
    for (const auto& [block_index, of_block] : of_blocks) all += of_block;
    for (const auto& [row, of_row] : of_blocks) {
      const TermForces forces = of_row * stiffness;
      products[static_cast<std::size_t>(row)] += forces * all.bottomRows<kMaxMotions>().transpose();
      for (const auto& [column, of_column] : of_blocks)
        if (column <= row) block(row, column) += forces * of_column.transpose();
    }
  }
  void add(const TermBlocks& more) {
    for (const auto& [place, block_of_more] : more.blocks) block(place.first, place.second) += block_of_more;
    for (std::size_t p = 0; p < products.size(); ++p) products[p] += more.products[p];
  }
  Block& block(int row, int column) { return blocks.try_emplace({row, column}, Block::Zero()).first->second; }

  std::map<std::pair<int, int>, Block> blocks;
  std::vector<BlockMotions::Products> products;
};

}  // namespace

// Marks the motions of a diagonal block that are not independent of the directions before them as
// not used.
void BlockMotions::find_used(std::size_t block_index, const Block& block) {
  std::vector<int> used;
  for (int k = 0; k < kDirections; ++k) {
    bool& is_used = is_used_[block_index][static_cast<std::size_t>(k)];
    if (is_used && k >= 3) {
      double shared = 0;
      if (!used.empty()) {
        const Eigen::VectorXd coupling = block(used, k);
        shared = coupling.dot(Eigen::MatrixXd(block(used, used)).ldlt().solve(coupling));
      }
      is_used = block(k, k) - shared > kMinIndependentEnergy * block(k, k);
    }
    if (is_used) used.push_back(k);
  }
}

template <class Real>
void BlockMotions::prepare(const LinearSystem& system, std::span<const std::size_t> selected,
                           const std::array<std::span<const PaddedVec3<Real>>, kMaxMotions>& motions,
                           std::span<const Mat3> row_sums, std::span<const Products> products) {
  // Positions of diagonal blocks among the selected ones; −1 if a block is not selected.
  const std::vector<DiagonalBlock> blocks = blocks_of(system);
  std::vector<int> numbers(blocks.size(), -1);
  for (std::size_t s = 0; s < selected.size(); ++s) numbers[selected[s]] = static_cast<int>(s);
  const auto number_of = [&](Index particle) { return numbers[block_of_row(blocks, particle)]; };
  std::array<bool, kDirections> all;
  for (int k = 0; k < kDirections; ++k) all[static_cast<std::size_t>(k)] = k < 3 || !motions[k - 3].empty();
  is_used_.assign(selected.size(), all);
  for (const ParticleConstraint& c : system.constraints)
    if (const int block_index = number_of(c.particle); block_index >= 0)
      std::fill_n(is_used_[static_cast<std::size_t>(block_index)].begin(), 3, false);

  const auto directions_at = [&](Index particle) {
    TermForces result = TermForces::Zero();
    result.template topRows<3>() = Mat3::Identity();
    for (int m = 0; m < kMaxMotions; ++m)
      if (!motions[m].empty()) result.row(3 + m) = vec3_of(motions[m][static_cast<std::size_t>(particle)]);
    return result;
  };
  // Threads sum chunks of terms; the sums of chunks are then added in a fixed order.
  const std::size_t count = term_count(system);
  std::vector<TermBlocks> of_chunks((count + kFineGrainSize - 1) / kFineGrainSize, TermBlocks(selected.size()));
  parallel_for(count, kFineGrainSize, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<int, TermForces>> of_blocks;
    for (std::size_t t = begin; t < end; ++t) {
      const AnyTerm term = term_at(system, t);
      of_blocks.clear();
      for (std::size_t k = 0; k < term.particles.size(); ++k) {
        const int block_index = term.weights[k] == 0 ? -1 : number_of(term.particles[k]);
        if (block_index < 0) continue;
        auto entry = std::ranges::find(of_blocks, block_index, &std::pair<int, TermForces>::first);
        if (entry == of_blocks.end()) entry = of_blocks.insert(entry, {block_index, TermForces::Zero()});
        entry->second += term.weights[k] * directions_at(term.particles[k]);
      }
      of_chunks[begin / kFineGrainSize].add(of_blocks, term.stiffness);
    }
  });
  TermBlocks terms(selected.size());
  for (const TermBlocks& of_chunk : of_chunks) terms.add(of_chunk);
  for (const RankOneTerm& term : system.rank_one_terms) {
    const int block_index = number_of(term.begin);
    if (block_index < 0) continue;
    AlongMotions along = AlongMotions::Zero();
    for (std::size_t i = 0; i < term.direction.size(); ++i)
      along += directions_at(term.begin + static_cast<Index>(i)) * term.direction[i];
    terms.block(block_index, block_index) += term.stiffness * along * along.transpose();
    terms.products[static_cast<std::size_t>(block_index)] +=
        term.stiffness * along * along.template tail<kMaxMotions>().transpose();
  }

  for (std::size_t s = 0; s < selected.size(); ++s) {
    Block& block = terms.block(static_cast<int>(s), static_cast<int>(s));
    const Products of_matrix = products[s] - terms.products[s];
    block.topLeftCorner<3, 3>() += row_sums[s];
    block.template rightCols<kMaxMotions>() += of_matrix;
    block.template bottomLeftCorner<kMaxMotions, 3>() += of_matrix.template topRows<3>().transpose();
    find_used(s, block);
  }
  const auto is_used = [&](int row) {
    return is_used_[static_cast<std::size_t>(row / kDirections)][static_cast<std::size_t>(row % kDirections)];
  };
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [place, block] : terms.blocks)
    for (int k = 0; k < kDirections; ++k)
      for (int l = 0; l < kDirections; ++l) {
        const int row = kDirections * place.first + k, column = kDirections * place.second + l;
        if (is_used(row) && is_used(column)) entries.emplace_back(row, column, block(k, l));
      }
  const int size = kDirections * static_cast<int>(selected.size());
  for (int k = 0; k < size; ++k)
    if (!is_used(k)) entries.emplace_back(k, k, 1);
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(matrix);
}

std::vector<AlongMotions> BlockMotions::solve(std::span<const AlongMotions> forces) const {
  Eigen::VectorXd right(kDirections * std::ssize(forces));
  for (std::size_t s = 0; s < forces.size(); ++s)
    for (int k = 0; k < kDirections; ++k)
      right[kDirections * static_cast<Eigen::Index>(s) + k] =
          is_used_[s][static_cast<std::size_t>(k)] ? forces[s][k] : 0;
  const Eigen::VectorXd solution = factor_.solve(right);
  std::vector<AlongMotions> result;
  for (std::size_t s = 0; s < forces.size(); ++s)
    result.emplace_back(solution.segment<kDirections>(kDirections * static_cast<Eigen::Index>(s)));
  return result;
}

template void BlockMotions::prepare<float>(const LinearSystem&, std::span<const std::size_t>,
                                           const std::array<std::span<const PaddedVec3<float>>, kMaxMotions>&,
                                           std::span<const Mat3>, std::span<const Products>);
template void BlockMotions::prepare<double>(const LinearSystem&, std::span<const std::size_t>,
                                            const std::array<std::span<const PaddedVec3<double>>, kMaxMotions>&,
                                            std::span<const Mat3>, std::span<const Products>);

}  // namespace weft::solver
