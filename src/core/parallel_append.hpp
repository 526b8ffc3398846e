// Deterministic parallel loops that append to lists, find a maximum or test a condition.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/parallel.hpp"

namespace weft {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Calls body(begin, end, list) for consecutive chunks of [0, count) with `chunk` items each; on
/// one thread, once for all of [0, count). `body` appends its results to `list`. Appends all
/// results to `out`, in the order of items. `List` needs a function append(List&, const List&) that
/// appends the second list to the first.
template <class List, class Body>
void parallel_append(std::size_t count, std::size_t chunk, List& out, const Body& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (chunks <= 1 || thread_count() == 1) {
    const CountedLoop counted(chunks);
    return body(std::size_t{0}, count, out);
  }
  std::vector<List> found(chunks);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) { body(begin, end, found[begin / chunk]); });
  for (const List& list : found) append(out, list);
}

/// The maximum of `lower_bound` and body(begin, end) over the chunks of [0, count).
template <class Number, class Body>
Number parallel_max(std::size_t count, std::size_t chunk, Number lower_bound, const Body& body) {
  std::vector<Number> largest((count + chunk - 1) / chunk, lower_bound);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) { largest[begin / chunk] = body(begin, end); });
  for (const Number& number : largest) lower_bound = std::max(lower_bound, number);
  return lower_bound;
}

/// Whether holds(i) is true for all i in [0, count).
template <class Holds>
bool parallel_all_of(std::size_t count, const Holds& holds) {
  return parallel_sum(count, kGrainSize, [&](std::size_t begin, std::size_t end) {
           while (begin < end && holds(begin)) ++begin;
           return begin < end ? 1 : 0;
         }) == 0;
}

}  // namespace weft
