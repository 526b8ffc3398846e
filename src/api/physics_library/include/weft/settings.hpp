// Settings of the whole process. Set them before the first simulation.
#pragma once

#include <functional>
#include <string_view>
#include <weft/api.hpp>

namespace weft {

/// Version of the library: "0.1.0".
WEFT_API const char* version();

/// Sets the largest number of threads; 0: as many as there are processors. Results do not depend on it.
/// Throws std::invalid_argument for a number below 0.
WEFT_API void set_threads(int threads);

/// Sends each message about a model or scene to `handle`, instead of standard error. `handle` is called by the
/// thread that loads or simulates. If several threads do so, calls may be concurrent. An empty function restores
/// standard error.
WEFT_API void set_warning_handler(std::function<void(std::string_view warning)> handle);

/// Calls `check` many times a second while a simulation computes, in the thread that called it. To interrupt a frame,
/// `check` throws: Simulation::advance() then throws the same, and frame() stays as it was. An empty function ends
/// this.
WEFT_API void set_interrupt_check(std::function<void()> check);

}  // namespace weft
