// Runs code that cannot be trusted with damaged input in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace weft::assets {

/// Calls `work` in a child process and returns its bytes. Whatever becomes of the child, a crash, an endless loop or a
/// runaway allocation, this process goes on: it throws std::runtime_error with the reason, or with the text of the
/// exception that `work` threw. The child may use `cpu_seconds` of processor time and 16 GB of addresses. Other threads
/// of this process do not exist in the child: `work` must not wait for them.
std::string run_isolated(const std::function<std::string()>& work, unsigned cpu_seconds);

}  // namespace weft::assets
