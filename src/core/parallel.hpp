// Deterministic parallel loops. They divide work into chunks of a fixed size and combine partial results in the order
// of chunks. Thus the same input gives the same bits on any number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/timer.hpp"

namespace weft {

/// Sets the maximum number of threads of the loops below; 0: as many as processors. Call it before
/// any loop runs.
void set_thread_count(int threads);
/// The maximum number of threads that is in effect, at least 1.
int thread_count();

/// Times of the loops below, measured on one thread, and from them estimates of the times on
/// several threads. Only loops of several chunks count, and only if they do not run inside another
/// counted loop.
struct LoopCounts {
  static constexpr std::array<std::size_t, 4> kThreads{2, 4, 8, 16};

  std::int64_t loops = 0, chunks = 0;  ///< number of counted loops, and of their chunks
  double seconds = 0;                  ///< wall time of these loops
  /// Estimated wall time of these loops on each number of threads of kThreads, if all chunks of a loop take equal times
  /// and threads start without delay.
  std::array<double, kThreads.size()> seconds_on{};
};
/// The counts to which the loops below add; null: they count nothing. Set it only while
/// thread_count() is 1.
inline LoopCounts* counted_loops = nullptr;

/// Counts a loop if it has several chunks and `counted_loops` is not null. The lifetime of this
/// object is the wall time of the loop.
class CountedLoop {
 public:
  explicit CountedLoop(std::size_t chunks) : chunks_(chunks), counts_(chunks > 1 ? counted_loops : nullptr) {
    if (counts_ == nullptr) return;
    counted_loops = nullptr;  // do not count loops inside of this one
    timer_.restart();
  }
  ~CountedLoop() {
    if (counts_ == nullptr) return;
    const double seconds = timer_.seconds();
    ++counts_->loops;
    counts_->chunks += static_cast<std::int64_t>(chunks_);
    counts_->seconds += seconds;
    for (std::size_t t = 0; t < LoopCounts::kThreads.size(); ++t) {
      const std::size_t threads = LoopCounts::kThreads[t], rounds = (chunks_ + threads - 1) / threads;
      counts_->seconds_on[t] += seconds * static_cast<double>(rounds) / static_cast<double>(chunks_);
    }
    counted_loops = counts_;
  }
  CountedLoop(const CountedLoop&) = delete;
  CountedLoop& operator=(const CountedLoop&) = delete;

 private:
  std::size_t chunks_;
  LoopCounts* counts_;
  WallTimer timer_;
};

/// Numbers of items per chunk for which a chunk takes 10 to 50 µs. kGrainSize: for vectors and
/// lists of pairs. kFineGrainSize: for more expensive items, such as contacts and leaves of
/// hierarchies. Other values change the bits of sums.
inline constexpr std::size_t kGrainSize = 1024, kFineGrainSize = 256;

/// Reference to a function of an index. The function must outlive the reference.
class FunctionOfIndex {
 public:
  template <class Function>
  explicit FunctionOfIndex(const Function& function)
      : function_(&function),
        call_([](const void* called, std::size_t index) { (*static_cast<const Function*>(called))(index); }) {}
  void operator()(std::size_t index) const { call_(function_, index); }

 private:
  const void* function_;
  void (*call_)(const void* called, std::size_t index);
};

/// Calls run(c) for each c below `chunks`, and returns when all calls have returned. The order of
/// the calls is arbitrary, and several threads may share them. This function is not a template,
/// because to instantiate TBB's code for each loop would take a tenth of the build time.
void run_chunks(std::size_t chunks, FunctionOfIndex run);

/// Calls body(begin, end) for consecutive chunks of [0, count) with `chunk` items each, or fewer in the last. Chunks
/// must write to disjoint data.
template <class Body>
void parallel_for(std::size_t count, std::size_t chunk, const Body& body) {
  run_chunks((count + chunk - 1) / chunk,
             FunctionOfIndex([&](std::size_t c) { body(c * chunk, std::min(count, (c + 1) * chunk)); }));
}

/// Calls both functions, concurrently if there are several threads. They must not depend on each other.
template <class One, class Other>
void parallel_invoke(const One& one, const Other& other) {
  if (thread_count() == 1) {
    one();
    other();
  } else {
    run_chunks(2, FunctionOfIndex([&](std::size_t which) { which == 0 ? one() : other(); }));
  }
}

/// Sum of body(begin, end), a number or vector, over the chunks of [0, count) with `chunk` items
/// each, or fewer in the last. Adds in the order of chunks.
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
