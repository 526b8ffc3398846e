// Runs code in a process of its own: what cannot be trusted with damaged input, or what is to be measured by itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace weft {

struct Isolation {
  std::string name = "the process";         ///< as messages call it
  unsigned cpu_seconds = 0;                 ///< that it may use; 0: no limit
  unsigned wall_seconds = 0;                ///< after which it is killed, as where it waits for ever; 0: no limit
  std::uint64_t addresses = 0;              ///< [bytes] that it may ask for; 0: no limit
  const std::atomic<bool>* stop = nullptr;  ///< once true, it is killed; nullptr: never
};

/// Calls `work` in a child process and returns its bytes. Whatever becomes of the child, a crash, an endless loop or a
/// runaway allocation, this process goes on: it throws std::runtime_error with the reason, or with the text of the
/// exception that `work` threw; Error(interrupted) where it was stopped. Other threads of this process do not exist in
/// the child: `work` must not wait for them.
std::string run_isolated(const std::function<std::string()>& work, const Isolation& isolation);

}  // namespace weft
