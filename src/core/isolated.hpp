// Runs code in a child process: code that may crash on damaged input, or whose memory use is to be measured alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace weft {

struct Isolation {
  std::string name = "the process";         ///< name of the child in messages
  unsigned cpu_seconds = 0;                 ///< CPU time limit; 0: none
  unsigned wall_seconds = 0;                ///< wall time limit, after which the child is killed; 0: none
  std::uint64_t max_address_space = 0;      ///< address space limit [bytes]; 0: none
  const std::atomic<bool>* stop = nullptr;  ///< if it becomes true, the child is killed; nullptr: never
};

/// Calls `work` in a child process and returns the bytes that `work` returned. The calling process
/// survives a crash of the child and, within the limits of `isolation`, an endless loop or a
/// runaway allocation. If `work` throws a std::exception, throws std::runtime_error with its text;
/// if memory or time runs out or the child crashes, throws std::runtime_error with the reason. If
/// `stop` becomes true, throws Error(interrupted). The child has a copy of the calling thread but of no other thread,
/// so `work` must not wait for other threads.
std::string run_isolated(const std::function<std::string()>& work, const Isolation& isolation);

}  // namespace weft
