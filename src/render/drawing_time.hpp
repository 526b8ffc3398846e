// What drawing costs: CPU time of its own thread, of those that rasterise for it and of those that help in its loops,
// whatever a simulation or an encoder beside it takes.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "core/parallel.hpp"
#include "core/timer.hpp"

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

/// CPU time of one picture, from here on, on one thread. The threads of the rasteriser belong to the process: of
/// pictures that are drawn at the same time each gets an equal share of theirs.
class DrawingTimer {
 public:
  DrawingTimer();
  ~DrawingTimer();
  DrawingTimer(const DrawingTimer&) = delete;
  DrawingTimer& operator=(const DrawingTimer&) = delete;

  double cpu_seconds() const;

 private:
  double began_;                   // on the clocks of this thread alone
  mutable double rasterised_ = 0;  // so far, for this picture; any timer shares out for all
};

}  // namespace weft::render
