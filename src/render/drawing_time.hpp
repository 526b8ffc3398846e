// What drawing costs: CPU time of its own thread, of those that rasterise for it and of those that help in its loops,
// whatever a simulation or an encoder beside it takes.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "render/gl/context.hpp"

namespace weft::render {

/// CPU seconds that other threads have spent in loops of the calling thread.
inline thread_local double helped_cpu_seconds = 0;

/// parallel_for() for drawing: of threads that help the time counts as the caller's.
template <class Body>
void drawing_for(std::size_t count, std::size_t chunk, const Body& body) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<double> helped = 0;
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) {
    if (std::this_thread::get_id() == caller) return body(begin, end);
    const double before = thread_cpu_seconds();
    body(begin, end);
    helped += thread_cpu_seconds() - before;
  });
  helped_cpu_seconds += helped;
}

/// All of it so far, for the calling thread. Threads of the rasteriser belong to the process: of two renderers that
/// draw at the same time each would count those of both.
inline double drawing_cpu_seconds() {
  return thread_cpu_seconds() + helped_cpu_seconds + rasteriser_cpu_seconds();
}

}  // namespace weft::render
