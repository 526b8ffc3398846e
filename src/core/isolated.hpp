// Runs code in a child process: code that may crash on damaged input, or code whose memory use is measured alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace weft {

struct Isolation {
  std::string name = "the process";  ///< used in messages
  unsigned cpu_seconds = 0;          ///< CPU time limit; 0: none
  unsigned wall_seconds = 0;         ///< wall time limit, after which the child is killed, even if it waits; 0: none
  std::uint64_t addresses = 0;       ///< address space limit [bytes]; 0: none
  const std::atomic<bool>* stop = nullptr;  ///< if it becomes true, the child is killed; nullptr: never
};

/// Calls `work` in a child process and returns the bytes that `work` returned. This process survives whatever happens
/// to the child (a crash, an endless loop, a runaway allocation). If the child fails, run_isolated() throws
/// std::runtime_error with the reason, or with the text of the exception that `work` threw; if `stop` became true, it
/// throws Error(interrupted). Other threads of this process do not exist in the child: `work` must not wait for them.
std::string run_isolated(const std::function<std::string()>& work, const Isolation& isolation);

}  // namespace weft
