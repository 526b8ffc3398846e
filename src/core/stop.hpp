// The request to stop a run. Long computations poll it.
#pragma once

#include <time.h>

#include <atomic>
#include <functional>

#include "core/error.hpp"

namespace weft {

/// Time of the request on the monotonic clock [ns]; 0: no request. A signal handler may set it.
inline std::atomic<long long> stop_requested_at{0};
static_assert(std::atomic<long long>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

/// Time that the current frame may still take after a request [ns]. Most frames end within this
/// time and are therefore kept.
inline constexpr long long kStopGrace = 3'000'000'000;

/// Time on the monotonic clock [ns]. Safe in a signal handler.
inline long long monotonic_ns() {
  timespec clock{};
  clock_gettime(CLOCK_MONOTONIC, &clock);
  return clock.tv_sec * 1'000'000'000LL + clock.tv_nsec;
}

/// Function that a program which uses the library may set; empty: none. If the function throws, its exception ends the
/// computation.
inline std::function<void()> host_check;

/// Calls host_check, if there is one, and lets its exception pass. Throws Error(interrupted) if a
/// stop was requested more than kStopGrace ago. Loops that may run longer than kStopGrace call this
/// function in each iteration.
inline void end_if_stopped() {
  if (host_check) host_check();
  const long long requested = stop_requested_at.load(std::memory_order_relaxed);
  if (requested != 0 && monotonic_ns() - requested > kStopGrace)
    throw Error(ExitCode::interrupted, "interrupted within a time step");
}

}  // namespace weft
