// Lists of the elements that act on each range of particles, so that threads can add forces to
// different ranges at the same time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "physics/forces/force.hpp"

namespace weft::forces {

/// For each range of particles, the elements (or packs of elements) of a list that act on a
/// particle in this range. An element with particles in several ranges is in the list of each of
/// these ranges. ForceRows and AssemblyRows then keep only what belongs to the particles of the
/// evaluated range.
class Ranges {
 public:
  /// `bounds`: see Force::partition(). touch(element, visit) must call visit(particle) for all particles of an element.
  template <class Touch>
  void partition(std::span<const Index> bounds, std::size_t count, const Touch& touch) {
    runs_.assign(bounds.size() - 1, {});
    for (std::size_t e = 0; e < count; ++e)
      touch(e, [&](Index particle) {
        const auto range = std::ranges::upper_bound(bounds, particle) - bounds.begin() - 1;
        std::vector<Run>& runs = runs_[static_cast<std::size_t>(range)];
        if (runs.empty() || runs.back().end < e)
          runs.push_back({e, e + 1});
        else
          runs.back().end = e + 1;
      });
  }

  /// Calls body(element) for the elements of a range, or for all `count` elements if the range is Evaluation::kAll, in
  /// ascending order.
  template <class Body>
  void for_each(std::size_t range, std::size_t count, const Body& body) const {
    if (range == Evaluation::kAll) {
      for (std::size_t e = 0; e < count; ++e) body(e);
      return;
    }
    for (const Run& run : runs_[range])
      for (std::size_t e = run.begin; e < run.end; ++e) body(e);
  }

 private:
  struct Run {
    std::size_t begin, end;
  };
  std::vector<std::vector<Run>> runs_;  // per range
};

}  // namespace weft::forces
