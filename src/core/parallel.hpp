// Deterministic parallel loops: work is divided into chunks of a fixed size, and partial results are combined in the
// order of chunks, so that the same input gives the same bits on any number of threads.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weft {

/// Sets the maximum number of threads of the loops below; 0: all cores. Call before any loop runs.
void set_thread_count(int threads);
int thread_count();

/// Items per chunk, so that a chunk takes 10 to 50 µs: the first for vectors and lists of pairs, the second for more
/// expensive items (contacts, leaves). Changing them changes the bits of sums.
inline constexpr std::size_t kGrainSize = 1024, kFineGrainSize = 256;

/// Calls body(begin, end) for consecutive chunks of [0, count) with `chunk` items each, or fewer in the last. Chunks
/// must write to disjoint data.
template <class Body>
void parallel_for(std::size_t count, std::size_t chunk, const Body& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto run = [&](std::size_t c) { body(c * chunk, std::min(count, (c + 1) * chunk)); };
  if (chunks <= 1 || thread_count() == 1) {
    for (std::size_t c = 0; c < chunks; ++c) run(c);
  } else {
    tbb::parallel_for(std::size_t{0}, chunks, run);
  }
}

/// Calls both, at the same time if there are threads; they must not depend on each other.
template <class One, class Other>
void parallel_invoke(const One& one, const Other& other) {
  if (thread_count() == 1) {
    one();
    other();
  } else {
    tbb::parallel_invoke(one, other);
  }
}

/// Sum of body(begin, end) over the chunks of [0, count), of numbers or vectors; added in the order of chunks.
template <class Body>
auto parallel_sum(std::size_t count, std::size_t chunk, const Body& body) {
  using Sum = decltype(body(std::size_t{0}, count));
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (chunks <= 1) return count == 0 ? Sum{} : body(std::size_t{0}, count);
  std::vector<Sum> partial(chunks);
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) { partial[begin / chunk] = body(begin, end); });
  Sum sum{};
  for (const Sum& p : partial) sum += p;
  return sum;
}

}  // namespace weft
