// CPU time of drawing: the sum over the drawing thread, the rasteriser threads and the threads that help in its loops.
// A concurrent simulation or encoder does not count.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "core/parallel.hpp"
#include "core/timer.hpp"

namespace weft::render {

/// CPU seconds that other threads have spent in loops of the calling thread.
inline thread_local double helper_cpu_seconds = 0;

/// parallel_for() for drawing: CPU time of helping threads counts as the caller's.
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
  helper_cpu_seconds += helped;
}

/// CPU time of one picture, from construction on. All pictures of the process share the rasteriser threads: pictures
/// that are drawn at the same time split the time of these threads equally.
class DrawingTimer {
 public:
  DrawingTimer();
  ~DrawingTimer();
  DrawingTimer(const DrawingTimer&) = delete;
  DrawingTimer& operator=(const DrawingTimer&) = delete;

  double cpu_seconds() const;

 private:
  double start_seconds_;                   // CPU time of this thread at construction
  mutable double rasteriser_seconds_ = 0;  // rasteriser time of this picture; each timer updates that of all timers
};

}  // namespace weft::render
