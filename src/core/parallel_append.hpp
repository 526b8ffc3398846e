// Deterministic parallel loops that list what they find, or look for the largest.
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

/// Calls body(begin, end, list) for consecutive chunks of [0, count), `chunk` items each: it appends to the list what
/// it finds, and `out` receives all of it in the order of the items. append(out, list) puts one list behind another.
template <class List, class Body>
void parallel_append(std::size_t count, std::size_t chunk, List& out, const Body& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (chunks <= 1 || thread_count() == 1) return body(std::size_t{0}, count, out);
  std::vector<List> found(chunks);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) { body(begin, end, found[begin / chunk]); });
  for (const List& list : found) append(out, list);
}

/// The largest of body(begin, end) over chunks of [0, count), or `least` where that is larger.
template <class Number, class Body>
Number parallel_max(std::size_t count, std::size_t chunk, Number least, const Body& body) {
  std::vector<Number> largest((count + chunk - 1) / chunk, least);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) { largest[begin / chunk] = body(begin, end); });
  for (const Number& number : largest) least = std::max(least, number);
  return least;
}

}  // namespace weft
