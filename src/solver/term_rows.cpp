#include "solver/term_rows.hpp"

namespace weft::solver {

void TermRows::assign(const LinearSystem& system) {
  count_.assign(static_cast<std::size_t>(system.matrix.rows()), 0);
  const std::size_t terms = term_count(system);
  const auto for_each_end = [&](const auto& visit) {
    for (std::size_t t = 0; t < terms; ++t) {
      const AnyTerm term = term_at(system, t);
      for (std::size_t k = 0; k < term.particles.size(); ++k)
        if (term.weights[k] != 0) visit(term.particles[k], Entry{static_cast<Index>(t), static_cast<Index>(k)});
    }
  };
  std::size_t all = 0;
  for_each_end([&](Index particle, const Entry&) { ++count_[static_cast<std::size_t>(particle)], ++all; });
  rows_.clear();
  start_.assign(1, 0);
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (count_[i] == 0) continue;
    const auto place = static_cast<Index>(start_.back());
    rows_.push_back(static_cast<Index>(i));
    start_.push_back(start_.back() + static_cast<std::size_t>(count_[i]));
    count_[i] = place;  // from now on: where the next entry goes
  }
  entries_.resize(all);
  for_each_end([&](Index particle, const Entry& entry) {
    entries_[static_cast<std::size_t>(count_[static_cast<std::size_t>(particle)]++)] = entry;
  });
}

}  // namespace weft::solver
