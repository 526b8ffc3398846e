// Settings of the whole process. Set them before the first simulation.
#pragma once

#include <functional>
#include <string_view>
#include <weft/api.hpp>

namespace weft {

/// Version of the library, such as "0.1.0".
WEFT_API const char* version();

/// Sets the maximum number of threads; 0: as many as there are processors. Results do not depend on this number.
/// Throws std::invalid_argument if the number is below 0.
WEFT_API void set_threads(int threads);

/// Passes each message about a model or scene to `handle`, instead of printing it to standard
/// error. The thread that loads or simulates calls `handle`; if several threads load or simulate,
/// these calls may be concurrent. If `handle` is empty, messages go to standard error again.
WEFT_API void set_warning_handler(std::function<void(std::string_view warning)> handle);

/// Sets a function that each simulation calls before each Newton iteration, in the thread that uses
/// the simulation. If `check` throws, the frame is interrupted: Simulation::advance() throws the
/// same exception, and Simulation::frame() stays as it was. An empty function removes the check.
WEFT_API void set_interrupt_check(std::function<void()> check);

}  // namespace weft
