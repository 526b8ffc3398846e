// CPU time of drawing: the sum over the drawing thread, the rasteriser threads, and the threads that execute parts of
// parallel loops of the drawing thread. The time of a concurrent simulation or encoder is excluded.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "core/parallel.hpp"
#include "core/timer.hpp"

namespace weft::render {

/// CPU time that other threads have spent in loops that this thread started by drawing_for() [s].
inline thread_local double helper_cpu_seconds = 0;

/// parallel_for() for drawing. Adds the CPU time of other threads in this loop to helper_cpu_seconds of the caller.
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

/// Calls body(y) for each of `rows` rows of a picture by drawing_for(), `chunk` rows at once.
template <class Body>
void drawing_rows(int rows, const Body& body, std::size_t chunk = 8) {
  drawing_for(static_cast<std::size_t>(rows), chunk, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

/// CPU time of one picture, from the construction of the timer on. All pictures of the process
/// share the rasteriser threads. If several timers exist, the time of these threads is split
/// equally among them.
class DrawingTimer {
 public:
  DrawingTimer();
  ~DrawingTimer();
  DrawingTimer(const DrawingTimer&) = delete;
  DrawingTimer& operator=(const DrawingTimer&) = delete;

  double cpu_seconds() const;

 private:
  double start_seconds_;                   // CPU time of this thread at construction
  mutable double rasteriser_seconds_ = 0;  // [s]; updated when any timer is read
};

}  // namespace weft::render
